/// ArduinoPort: the driver's way to the hardware on any Arduino: the SPI library and digital pins.
///
/// SPI is shared as Arduino's rules want it: each access is a transaction of its own, so other
/// devices on the same SPI, and interrupts that use it (SPI.usingInterrupt()), are safe.
/// With Roio.h and the pins the only files that know Arduino. Include Roio.h, not this.
#ifndef ROIO_ARDUINO_PORT_HPP
#define ROIO_ARDUINO_PORT_HPP

#include <Arduino.h>
#include <SPI.h>

// ROIO_PORTABLE_PINS: Arduino's functions on an AVR, too, for comparison.
#if defined(__AVR__) && !defined(ROIO_PORTABLE_PINS)
#include <roio/arduino_pins_avr.hpp>
#else
#include <roio/arduino_pins.hpp>
#endif

namespace roio {

/// The most that the chip takes.
constexpr uint32_t spi_hz = 10000000;

class NoPin {
 public:
  static constexpr bool is_used = false;
  static void begin_input() {}
  static bool is_low() { return false; }
};

namespace detail {
template <int Number>
struct PinOrNone {
  using Type = FixedPin<static_cast<uint8_t>(Number)>;
};
template <>
struct PinOrNone<-1> {
  using Type = NoPin;
};
}  // namespace detail

/// FixedPin<Number>; NoPin for -1.
template <int Number>
using PinOrNone = typename detail::PinOrNone<Number>::Type;

/// @tparam ChipSelect FixedPin or SetPin. @tparam Interrupt FixedPin or NoPin.
template <typename ChipSelect, typename Interrupt>
class ArduinoPort {
 public:
  static constexpr bool has_interrupt_line = Interrupt::is_used;

  /// Touches no hardware: it may be called before Arduino has set up its own.
  template <typename... Arguments>
  explicit constexpr ArduinoPort(Arguments... pin) : chip_select_(pin...) {}

  void begin() {
    chip_select_.begin_output_high();
    Interrupt::begin_input();
    begin_spi<ChipSelect>();
  }

  const ChipSelect& chip_select() const { return chip_select_; }

  bool interrupt_line_is_low() { return Interrupt::is_low(); }
  ROIO_OUT_OF_LINE void pause(uint16_t microseconds) { delayMicroseconds(microseconds); }
  uint32_t microseconds() { return micros(); }

  class Transaction {
   public:
    ROIO_IN_LINE Transaction(ArduinoPort& port, uint8_t first)
        : port_(port), is_selected_(true), is_sending_(true) {
      port_.select(first);
    }
    ROIO_IN_LINE ~Transaction() {
      if (is_selected_) {
        release();
      }
      SPI.endTransaction();
    }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    ROIO_IN_LINE void put(uint8_t byte) {
      spi_put(byte);
      is_sending_ = true;
    }
    ROIO_IN_LINE void send(const uint8_t* bytes, uint8_t count) {
      spi_send(bytes, count);
      is_sending_ = true;
    }
    ROIO_IN_LINE uint8_t exchange(uint8_t byte) {
      is_sending_ = false;
      return spi_exchange(byte);
    }
    ROIO_IN_LINE uint8_t* receive(uint8_t* bytes, uint8_t count) {
      const bool was_sending = is_sending_;
      is_sending_ = false;
      return was_sending ? spi_receive(bytes, count) : spi_receive_more(bytes, count);
    }
    ROIO_IN_LINE void release() {
      if (is_sending_) {
        spi_finish();
        is_sending_ = false;
      }
      port_.chip_select_.set_high();
      is_selected_ = false;
    }
    ROIO_IN_LINE void restart(uint8_t first) {
      port_.start(first);
      is_selected_ = true;
      is_sending_ = true;
    }

   private:
    ArduinoPort& port_;
    // Known to the compiler at each place: they cost nothing.
    bool is_selected_;
    bool is_sending_;
  };

  class Uninterrupted : InterruptsOff {
   public:
    explicit Uninterrupted(ArduinoPort&) {}
  };

 private:
  // Out of line: they are called from everywhere, and spi_start() of an AVR wants it.
  ROIO_OUT_OF_LINE void select(uint8_t first) {
    SPI.beginTransaction(SPISettings(spi_hz, MSBFIRST, SPI_MODE0));
    chip_select_.set_low();
    spi_start(first);
  }
  ROIO_OUT_OF_LINE void start(uint8_t first) {
    chip_select_.set_low();
    spi_start(first);
  }

  ChipSelect chip_select_;
};

}  // namespace roio

#endif
