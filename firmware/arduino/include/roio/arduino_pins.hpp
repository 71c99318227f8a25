/// Pins and interrupts by Arduino's own functions, for any core.
///
/// A pin is a type, so that one that is known when compiling takes no RAM: FixedPin<10>, or NoPin;
/// SetPin is told its number by the sketch.
#ifndef ROIO_ARDUINO_PINS_HPP
#define ROIO_ARDUINO_PINS_HPP

#include <Arduino.h>
#include <SPI.h>

#include <roio/arduino_spi.hpp>

#define ROIO_OUT_OF_LINE __attribute__((noinline))
/// What a compiler sees through only where it stands.
#define ROIO_IN_LINE inline __attribute__((always_inline))

namespace roio {

template <uint8_t Number>
class FixedPin {
 public:
  static constexpr bool is_used = true;

  static void begin_output_high() {
    digitalWrite(Number, HIGH);
    pinMode(Number, OUTPUT);
    digitalWrite(Number, HIGH);  // some cores take the level only now
  }
  static void begin_input() { pinMode(Number, INPUT_PULLUP); }
  static void set_high() { digitalWrite(Number, HIGH); }
  static void set_low() { digitalWrite(Number, LOW); }
  static bool is_low() { return digitalRead(Number) == LOW; }
};

class SetPin {
 public:
  explicit constexpr SetPin(uint8_t number) : number_(number) {}
  uint8_t number() const { return number_; }

  void begin_output_high() {
    digitalWrite(number_, HIGH);
    pinMode(number_, OUTPUT);
    digitalWrite(number_, HIGH);
  }
  void set_high() { digitalWrite(number_, HIGH); }
  void set_low() { digitalWrite(number_, LOW); }

 private:
  uint8_t number_;
};

template <typename ChipSelect>
void begin_spi() {
  SPI.begin();
}
/// Interrupts are off while one lives, and on again after it if they were on before, where the core
/// can tell.
class InterruptsOff {
 public:
  InterruptsOff() : before_(state()) { noInterrupts(); }
  ~InterruptsOff() { restore(before_); }
  InterruptsOff(const InterruptsOff&) = delete;
  InterruptsOff& operator=(const InterruptsOff&) = delete;

 private:
#if defined(__AVR__)
  static uint32_t state() {
    return SREG;
  }
  static void restore(uint32_t state) {
    SREG = static_cast<uint8_t>(state);
  }
#elif defined(__ARM_ARCH) && defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'
  static uint32_t state() {
    uint32_t primask;
    __asm__ volatile("mrs %0, primask" : "=r"(primask));
    return primask;
  }
  static void restore(uint32_t state) {
    if (state == 0) {
      interrupts();
    }
  }
#else
  // Arduino has no word for "as before".
  static uint32_t state() {
    return 0;
  }
  static void restore(uint32_t) {
    interrupts();
  }
#endif

  uint32_t before_;
};

}  // namespace roio

#endif
