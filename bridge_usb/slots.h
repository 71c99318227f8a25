/// Slots: what became of the last 16 frames from the PC, two bits each, as RESULTS has it, and
/// until when each may wait. The driver's token of a frame is its slot, and which session's it is:
/// those of a former one are over, though they may still come to an end.
#ifndef ROIO_BRIDGE_SLOTS_H
#define ROIO_BRIDGE_SLOTS_H

#include "config.h"

namespace roio {
namespace bridge {

class Slots {
 public:
  static constexpr uint8_t no_token = 0xFF;      ///< Of a frame that has no slot: the bridge's own.
  static constexpr uint8_t default_life = 0x6F;  ///< 0.98 s: of such, and of SLCAN's.

  Slots()
      : bytes_(),
        until_(),
        soonest_(no_end),
        now_(0),
        generation_(0),
        pending_(0),
        news_(0),
        all_over_(false) {}

  void begin_session() {
    for (uint8_t& byte : bytes_) {
      byte = 0;
    }
    for (uint8_t slot = 0; slot < serial::window; ++slot) {
      until_[slot] = no_end;
    }
    generation_ = static_cast<uint8_t>((generation_ + 1U) % generations);
    pending_ = 0;
    news_ = 0;
  }
  uint8_t token_of(uint8_t sequence) const {
    return static_cast<uint8_t>((generation_ << 4) | (sequence & 0x0FU));
  }
  /// @param life as a frame's record has it.
  void begin(uint8_t token, uint8_t life) {
    put(token, serial::Outcome::pending);
    set_end(token & 0x0FU, life);
    ++pending_;
  }
  /// A frame of the bridge's own: with the last of them, all are over.
  void begin_own() { set_end(own, default_life); }
  void end(uint8_t token, serial::Outcome outcome) {
    if ((token >> 4) != generation_) {
      return;
    }
    put(token, outcome);
    until_[token & 0x0FU] = no_end;
    --pending_;
    add_news();
  }
  /// Of a frame that has an end: whether it still waits.
  bool is_pending(uint8_t token) const { return until_[token & 0x0FU] != no_end; }

  /// @param now Clock::coarse().
  /// @return whether frames are over that the driver may have.
  bool pass_time(uint16_t now) {
    now_ = now;
    return soonest_ != no_end && is_past(soonest_) && look_for_expired();
  }
  /// All that wait are over, or as they were.
  void set_all_over(bool over) { all_over_ = over; }
  bool is_over(uint8_t token) const {
    if (token == no_token) {
      return all_over_ || until_[own] == no_end || is_past(until_[own]);
    }
    const uint16_t until = until_[token & 0x0FU];
    return all_over_ || (token >> 4) != generation_ || (until != no_end && is_past(until));
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
  static constexpr uint8_t again_after = 8;

  static constexpr uint16_t not_no_end(uint16_t time) {
    return time == no_end ? static_cast<uint16_t>(no_end - 1U) : time;
  }
  bool is_past(uint16_t time) const { return static_cast<uint16_t>(now_ - time) < 0x8000U; }
  void note_end(uint16_t until) {
    if (soonest_ == no_end || static_cast<uint16_t>(until - soonest_) >= 0x8000U) {
      soonest_ = until;
    }
  }
  void set_end(uint8_t place, uint8_t life) {
    uint16_t until = no_end;
    if (life != serial::life_forever) {
      life = life < serial::longest_life ? life : serial::longest_life;
      until = not_no_end(static_cast<uint16_t>(now_ + serial::life_units(life)));
      note_end(until);
    }
    until_[place] = until;
  }
  bool look_for_expired() {
    bool any = false;
    soonest_ = no_end;
    for (uint16_t until : until_) {
      if (until != no_end && is_past(until)) {
        any = true;
        until = not_no_end(static_cast<uint16_t>(now_ + again_after));  // unless it ends before
      }
      if (until != no_end) {
        note_end(until);
      }
    }
    if (is_past(until_[own])) {
      until_[own] = no_end;
    }
    return any;
  }

  void put(uint8_t token, serial::Outcome outcome) {
    static const uint8_t ones[4] = {0x01, 0x04, 0x10, 0x40};  // an AVR shifts bit by bit
    uint8_t& byte = bytes_[(token >> 2) & 3U];
    const uint8_t one = ones[token & 3U];
    byte = static_cast<uint8_t>((byte & ~(one * 3U)) | (one * static_cast<uint8_t>(outcome)));
  }

  uint8_t bytes_[4];
  uint16_t until_[serial::window + 1];  // Clock::coarse(): of each slot, and of the bridge's own
  uint16_t soonest_;                    // of those, or before it
  uint16_t now_;
  uint8_t generation_;
  uint8_t pending_;
  uint8_t news_;
  bool all_over_;
};

}  // namespace bridge
}  // namespace roio

#endif
