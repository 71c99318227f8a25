/// Slots: what became of the last 16 frames from the PC, two bits each, as RESULTS has it, and
/// until when each may wait. The driver's token of a frame is its slot, and which session's it is:
/// those of a former one are over, though they may still come to an end.
#ifndef ROIO_BRIDGE_SLOTS_H
#define ROIO_BRIDGE_SLOTS_H

#include "config.h"

namespace roio {
namespace bridge {

/// Until when each slot's frame may wait, and the bridge's own; in Clock::coarse().
struct Lives {
  uint16_t ends[serial::window + 1];
  uint16_t now;
  uint16_t units;  ///< That a frame with `life` may wait, less the time to the next look.
  uint8_t life;
  uint8_t next;  ///< That was looked at last.
  bool all_over;
};
// Outside the class: the driver holds that in front of its own members, and an AVR reaches 64 bytes
// from a pointer.
static Lives lives;

class Slots {
 public:
  static constexpr uint8_t no_token = 0xFF;      ///< Of a frame that has no slot: the bridge's own.
  static constexpr uint8_t default_life = 0x6F;  ///< 0.98 s: of such, and of SLCAN's.

  Slots() : bytes_(), generation_(0), pending_(0), news_(0) {}

  void begin_session() {
    for (uint8_t& byte : bytes_) {
      byte = 0;
    }
    for (uint8_t slot = 0; slot < serial::window; ++slot) {
      lives.ends[slot] = no_end;
    }
    generation_ = static_cast<uint8_t>((generation_ + 1U) % generations);
    pending_ = 0;
    news_ = 0;
  }
  uint8_t token_of(uint8_t sequence) const {
    return static_cast<uint8_t>((generation_ << 4) | (sequence & 0x0FU));
  }
  /// @param life as a frame's record has it.
  ROIO_BRIDGE_FAST void begin(uint8_t token, uint8_t life) {
    put(token, serial::Outcome::pending);
    lives.ends[token & 0x0FU] = end_of(life);
    ++pending_;
  }
  /// A frame of the bridge's own: with the last of them, all are over.
  static void begin_own() { lives.ends[own] = end_of(default_life); }
  ROIO_BRIDGE_FAST void end(uint8_t token, serial::Outcome outcome) {
    if ((token >> 4) != generation_) {
      return;
    }
    put(token, outcome);
    lives.ends[token & 0x0FU] = no_end;
    --pending_;
    add_news();
  }
  /// Of a frame that has an end: whether it still waits.
  static bool is_pending(uint8_t token) { return lives.ends[token & 0x0FU] != no_end; }

  /// To be called every millisecond: looks at some of them, at all in 6 ms. The bus waits
  /// meanwhile.
  /// @param now Clock::coarse().
  /// @return whether frames are over that the driver may have.
  static bool pass_time(uint16_t now) {
    lives.now = now;
    bool any = false;
    for (uint8_t looks = looks_at_once; looks != 0; --looks) {
      lives.next = lives.next == own ? uint8_t{0} : static_cast<uint8_t>(lives.next + 1U);
      if (is_past(lives.ends[lives.next])) {
        any = true;
      }
    }
    if (any && is_past(lives.ends[own])) {
      lives.ends[own] = no_end;
    }
    return any;
  }
  /// All that wait are over, or as they were.
  static void set_all_over(bool over) { lives.all_over = over; }
  bool is_over(uint8_t token) const {
    if (token == no_token) {
      return lives.all_over || lives.ends[own] == no_end || is_past(lives.ends[own]);
    }
    return lives.all_over || (token >> 4) != generation_ || is_past(lives.ends[token & 0x0FU]);
  }

  /// What the PC does not know yet: a frame was taken, or came to its end.
  void add_news() { ++news_; }
  void take_news() { news_ = 0; }
  bool has_news() const { return news_ != 0; }
  /// Several are told at once, the more so while the bus is busy with others' frames; a frame that
  /// is alone is told at once.
  bool is_news_due(bool is_busy) const {
    return news_ != 0 && (news_ >= (is_busy ? busy_news : enough_news) || pending_ == 0);
  }
  /// Slots 4n+3..4n.
  uint8_t byte(uint8_t n) const { return bytes_[n]; }

 private:
  static constexpr uint8_t enough_news = 6;
  static constexpr uint8_t busy_news = 12;
  static constexpr uint8_t generations = 15;  // with a 16th, no_token would be a token
  static constexpr uint8_t own = serial::window;
  static constexpr uint16_t no_end = 0;  // of a frame that may wait for ever; or there is none
  static constexpr uint8_t looks_at_once = 3;
  static constexpr uint8_t look_interval = 8;  // 6, and what a busy bus makes of it

  static bool is_past(uint16_t end) {
    return end != no_end && static_cast<uint16_t>(lives.now - end) < 0x8000U;
  }
  /// Early enough for the next look to be in time.
  ROIO_BRIDGE_FAST static uint16_t end_of(uint8_t life) {
    if (life !=
        lives.life) {  // most often it is that of the frame before, and an AVR shifts bit by bit
      lives.life = life;
      const uint8_t known = life < serial::longest_life ? life : serial::longest_life;
      const uint16_t units = serial::life_units(known);
      lives.units =
          units < look_interval ? uint16_t{0} : static_cast<uint16_t>(units - look_interval);
    }
    return life == serial::life_forever ? no_end
                                        : static_cast<uint16_t>((lives.now + lives.units) | 1U);
  }

  ROIO_BRIDGE_FAST void put(uint8_t token, serial::Outcome outcome) {
    static const uint8_t ones[4] = {0x01, 0x04, 0x10, 0x40};  // an AVR shifts bit by bit
    uint8_t& byte = bytes_[(token >> 2) & 3U];
    const uint8_t one = ones[token & 3U];
    byte = static_cast<uint8_t>((byte & ~(one * 3U)) | (one * static_cast<uint8_t>(outcome)));
  }

  uint8_t bytes_[4];
  uint8_t generation_;
  uint8_t pending_;
  uint8_t news_;
};

}  // namespace bridge
}  // namespace roio

#endif
