/// ArduinoPort: the driver's way to the hardware on any Arduino: the SPI library and digital pins.
///
/// SPI is shared as Arduino's rules want it: each access is a transaction of its own, so other
/// devices on the same SPI, and interrupts that use it (SPI.usingInterrupt()), are safe.
/// With Roio.h the only file that knows Arduino. Include Roio.h, not this.
#ifndef ROIO_ARDUINO_PORT_HPP
#define ROIO_ARDUINO_PORT_HPP

#include <Arduino.h>
#include <SPI.h>

namespace roio {

/// @tparam WithLine whether the chip's INT is connected to a pin.
template <bool WithLine>
class ArduinoPort {
 public:
  static constexpr bool has_interrupt_line = WithLine;

  /// Touches no hardware: it may be called before Arduino has set up its own.
  ArduinoPort(uint8_t chip_select_pin, uint8_t interrupt_pin)
      : chip_select_pin_(chip_select_pin), interrupt_pin_(interrupt_pin) {}

  void begin() {
    digitalWrite(chip_select_pin_, HIGH);
    pinMode(chip_select_pin_, OUTPUT);
    if (WithLine) {
      pinMode(interrupt_pin_, INPUT_PULLUP);
    }
    SPI.begin();
  }

  uint8_t chip_select_pin() const { return chip_select_pin_; }
  uint8_t interrupt_pin() const { return interrupt_pin_; }

  bool interrupt_line_is_low() { return digitalRead(interrupt_pin_) == LOW; }
  uint32_t microseconds() { return micros(); }

  class Transaction {
   public:
    explicit Transaction(ArduinoPort& port) : pin_(port.chip_select_pin_) {
      SPI.beginTransaction(SPISettings(10000000, MSBFIRST, SPI_MODE0));
      digitalWrite(pin_, LOW);
    }
    ~Transaction() {
      digitalWrite(pin_, HIGH);
      SPI.endTransaction();
    }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    uint8_t exchange(uint8_t out) { return SPI.transfer(out); }
    void restart() {
      digitalWrite(pin_, HIGH);
      digitalWrite(pin_, LOW);
    }

   private:
    uint8_t pin_;
  };

  class Uninterrupted {
   public:
    explicit Uninterrupted(ArduinoPort&) : before_(SREG) { noInterrupts(); }
    ~Uninterrupted() { SREG = before_; }
    Uninterrupted(const Uninterrupted&) = delete;
    Uninterrupted& operator=(const Uninterrupted&) = delete;

   private:
    uint8_t before_;
  };

 private:
  uint8_t chip_select_pin_;
  uint8_t interrupt_pin_;
};

}  // namespace roio

#endif
