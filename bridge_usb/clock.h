/// Clock: time in units of 4 us, by a timer that runs on its own. Reading it takes some cycles,
/// where Arduino's micros() takes 3 us.
#ifndef ROIO_BRIDGE_CLOCK_H
#define ROIO_BRIDGE_CLOCK_H

#include <avr/io.h>
#include <stdint.h>

namespace roio {
namespace bridge {

/// Must be read at least every 262 ms.
class Clock {
 public:
  Clock() : high_(0), last_(0) {}

  static void begin() {
    TCCR1A = 0;
    TCCR1B = (1U << CS11) | (1U << CS10);  // F_CPU / 64: 4 us at 16 MHz
    TIMSK1 = 0;
  }

  /// The low 16 bits: what a frame's record has.
  static uint16_t low_ticks() { return TCNT1; }

  uint32_t ticks() {
    const uint16_t low = TCNT1;
    if (low < last_) {
      ++high_;
    }
    last_ = low;
    return (static_cast<uint32_t>(high_) << 16) | low;
  }

  /// Units of 1.024 ms, modulo 2^16: for timeouts.
  uint16_t coarse() { return static_cast<uint16_t>(ticks() >> 8); }
  static constexpr uint16_t coarse_of_ms(uint16_t ms) {
    return static_cast<uint16_t>(static_cast<uint32_t>(ms) * 1000U / 1024U);
  }

 private:
  uint16_t high_;
  uint16_t last_;
};

}  // namespace bridge
}  // namespace roio

#endif
