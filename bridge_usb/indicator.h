/// Indicator: the board shows which one it is, by its LED. On an Uno that LED is SPI's clock, so
/// there it is the LED of the USB chip, TX, that blinks: by delimiters, which mean nothing.
#ifndef ROIO_BRIDGE_INDICATOR_H
#define ROIO_BRIDGE_INDICATOR_H

#include <Arduino.h>

#include "clock.h"
#include "line.h"

namespace roio {
namespace bridge {

class Indicator {
 public:
  Indicator(Line& line, Clock& clock) : line_(line), clock_(clock), began_at_(0), seconds_(0) {}

  static void begin() {
    if (has_led) {
      pinMode(LED_BUILTIN, OUTPUT);
    }
  }

  /// @param seconds 0: no more.
  void identify(uint8_t seconds) {
    began_at_ = clock_.ticks();
    seconds_ = seconds;
    if (seconds == 0) {
      show(false);
    }
  }

  void tend() {
    if (seconds_ == 0) {
      return;
    }
    const uint32_t elapsed = clock_.ticks() - began_at_;
    if (elapsed >= seconds_ * ticks_per_second) {
      identify(0);
    } else {
      show((elapsed & blink) == 0);
    }
  }

 private:
  static constexpr bool has_led = board != serial::Board::uno;
  static constexpr uint32_t ticks_per_second = 1000000 / serial::ticks_us;
  static constexpr uint32_t blink = UINT32_C(1) << 15;  // 131 ms on, 131 ms off
  static constexpr uint8_t burst = 16;

  void show(bool on) {
    if (has_led) {
      digitalWrite(LED_BUILTIN, on ? HIGH : LOW);
    } else if (on && line_.is_drained()) {
      Line::Sink sink = line_.sink();
      for (uint8_t i = 0; i < burst; ++i) {
        sink.put(i, serial::delimiter);
      }
      line_.commit(burst);
    }
  }

  Line& line_;
  Clock& clock_;
  uint32_t began_at_;
  uint8_t seconds_;
};

}  // namespace bridge
}  // namespace roio

#endif
