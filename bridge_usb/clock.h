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
  Clock() : high_(0), last_(0), coarse_(0) {}

  static void begin() {
    TCCR1A = 0;
    TCCR1B = (1U << CS11) | (1U << CS10);  // F_CPU / 64: 4 us at 16 MHz
    TIMSK1 = 0;
  }

  /// The low 16 bits: what a frame's record has.
  static uint16_t low_ticks() { return TCNT1; }

  uint32_t ticks() {
    update();
    return (static_cast<uint32_t>(high_) << 16) | last_;
  }

  /// Units of 1.024 ms, modulo 2^16, as of the last update(): for timeouts.
  uint16_t coarse() const { return coarse_; }
  /// @return whether coarse() is another one than before.
  bool update() {
    const uint16_t low = TCNT1;
    const uint8_t middle = static_cast<uint8_t>(low >> 8);
    if (low < last_) {
      ++high_;
    }
    last_ = low;
    const bool is_new = middle != static_cast<uint8_t>(coarse_);
    coarse_ = static_cast<uint16_t>(static_cast<uint16_t>(high_ << 8) | middle);
    return is_new;
  }
  static constexpr uint16_t coarse_of_ms(uint16_t ms) {
    return static_cast<uint16_t>(static_cast<uint32_t>(ms) * 1000U / 1024U);
  }

 private:
  uint16_t high_;
  uint16_t last_;
  uint16_t coarse_;
};

}  // namespace bridge
}  // namespace roio

#endif
