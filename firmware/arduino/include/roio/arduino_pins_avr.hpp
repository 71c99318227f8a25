/// Pins and interrupts of an AVR by its registers. A pin that is known when compiling is one
/// instruction, where Arduino's digitalWrite() takes 4 us and 150 bytes.
#ifndef ROIO_ARDUINO_PINS_AVR_HPP
#define ROIO_ARDUINO_PINS_AVR_HPP

#include <Arduino.h>
#include <SPI.h>

#include <roio/arduino_pin_map_avr.hpp>

// The SPI library sets half the clock for the 10 MHz of arduino_port.hpp up to here.
#if F_CPU <= 20000000
#include <roio/arduino_spi_avr.hpp>
#else
#include <roio/arduino_spi.hpp>
#endif

/// The linker's optimiser would copy these into every caller otherwise.
#define ROIO_OUT_OF_LINE __attribute__((noinline))
/// And would leave these out of line.
#define ROIO_IN_LINE inline __attribute__((always_inline))

namespace roio {

/// Interrupts are off while one lives, and on again after it if they were on before.
class InterruptsOff {
 public:
  InterruptsOff() : before_(SREG) { noInterrupts(); }
  ~InterruptsOff() { SREG = before_; }
  InterruptsOff(const InterruptsOff&) = delete;
  InterruptsOff& operator=(const InterruptsOff&) = delete;

 private:
  uint8_t before_;
};

/// A pin's bit in its port. PINx, DDRx and PORTx lie side by side in every AVR.
struct AvrPinBit {
  volatile uint8_t* port;
  uint8_t mask;

  // Other bits of the port may be an interrupt's.
  void begin_output_high() const {
    const InterruptsOff together;
    port[0] |= mask;
    port[-1] |= mask;
  }
  void begin_input() const {
    const InterruptsOff together;
    port[-1] &= static_cast<uint8_t>(~mask);
    port[0] |= mask;
  }
  void set_high() const {
    const InterruptsOff together;
    port[0] |= mask;
  }
  void set_low() const {
    const InterruptsOff together;
    port[0] &= static_cast<uint8_t>(~mask);
  }
  bool is_low() const { return (port[-2] & mask) == 0; }
};

#if defined(ROIO_AVR_SPI_SS)
constexpr bool is_spi_ss(AvrPinPlace place) {
  return place.port == avr_ports::b && place.bit == ROIO_AVR_SPI_SS;
}
#else
constexpr bool is_spi_ss(AvrPinPlace) {
  return false;
}
#endif

/// A pin that the board's map has: one instruction, which nothing can interrupt.
template <uint8_t Number, bool IsMapped = avr_pin_place(Number).is_reachable()>
class FixedPin {
 public:
  static constexpr bool is_used = true;
  static constexpr bool is_ss = is_spi_ss(avr_pin_place(Number));

  static void begin_output_high() {
    port<0>() |= mask;
    port<-1>() |= mask;
  }
  static void begin_input() {
    port<-1>() &= static_cast<uint8_t>(~mask);
    port<0>() |= mask;
  }
  ROIO_IN_LINE static void set_high() { port<0>() |= mask; }
  ROIO_IN_LINE static void set_low() { port<0>() &= static_cast<uint8_t>(~mask); }
  ROIO_IN_LINE static bool is_low() { return (port<-2>() & mask) == 0; }

 private:
  static constexpr uint8_t mask = 1U << avr_pin_place(Number).bit;
  /// PORTx at 0, DDRx at -1, PINx at -2.
  template <int Offset>
  ROIO_IN_LINE static volatile uint8_t& port() {
    constexpr uint16_t address = avr_pin_place(Number).port + Offset;
    return *reinterpret_cast<volatile uint8_t*>(address);
  }
};

/// Any other is looked up each time.
template <uint8_t Number>
class FixedPin<Number, false> {
 public:
  static constexpr bool is_used = true;
  static constexpr bool is_ss = false;  // as far as is known

  static void begin_output_high() { place().begin_output_high(); }
  static void begin_input() { place().begin_input(); }
  static void set_high() { place().set_high(); }
  static void set_low() { place().set_low(); }
  static bool is_low() { return place().is_low(); }

 private:
  static AvrPinBit place() {
    return {portOutputRegister(digitalPinToPort(Number)),
            static_cast<uint8_t>(digitalPinToBitMask(Number))};
  }
};

/// A pin that is looked up once.
class SetPin {
 public:
  static constexpr bool is_ss = false;  // not known when compiling
  explicit constexpr SetPin(uint8_t number) : number_(number), place_{nullptr, 0} {}

  uint8_t number() const { return number_; }

  void begin_output_high() {
    place_ = {portOutputRegister(digitalPinToPort(number_)),
              static_cast<uint8_t>(digitalPinToBitMask(number_))};
    place_.begin_output_high();
  }
  void set_high() { place_.set_high(); }
  void set_low() { place_.set_low(); }

 private:
  uint8_t number_;
  AvrPinBit place_;
};

/// What SPI.begin() does, without looking up pins that the processor has fixed; each transaction
/// switches SPI on by itself. SS has to be an output, or SPI may become a slave.
/// @tparam ChipSelect an output by now, and most often that very pin.
template <typename ChipSelect>
void begin_spi() {
#if defined(ROIO_AVR_SPI_SS)
  // One bit at a time: that is one instruction, and no interrupt comes between.
  if (!ChipSelect::is_ss) {
    if ((DDRB & (1U << ROIO_AVR_SPI_SS)) == 0) {
      PORTB |= 1U << ROIO_AVR_SPI_SS;
    }
    DDRB |= 1U << ROIO_AVR_SPI_SS;
  }
  DDRB |= 1U << ROIO_AVR_SPI_MOSI;
  DDRB |= 1U << ROIO_AVR_SPI_SCK;
#else
  SPI.begin();
#endif
}

}  // namespace roio

#endif
