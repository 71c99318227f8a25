#ifndef ROIO_SERIAL_DOWN_HPP
#define ROIO_SERIAL_DOWN_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <roio/frame.hpp>
#include <roio/parts/lanes.hpp>
#include <roio/serial_protocol.hpp>
#include <span>

#include "serial/clock.hpp"

namespace roio::serial {

/// Frames on their way to the bridge: they wait in two lanes until there is room in the window;
/// there each has a number, and stays until its outcome is known. Each has an end, after which it
/// is not to be on the bus any more: until it has a number that is seen to here, then by the
/// bridge, which its record tells.
class DownFrames {
 public:
  static constexpr std::size_t lane_capacity = 64;
  /// Bytes that are sent before RESULTS says that some were taken: a bridge that is busy with its
  /// controller lets them wait in a buffer of 255 bytes, POLL and other records among them.
  static constexpr std::size_t max_untaken = 180;

  struct Counters {
    std::uint64_t sent = 0;      ///< On the bus, and acknowledged.
    std::uint64_t not_sent = 0;  ///< Given up by the bridge.
    std::uint64_t unknown = 0;   ///< Their session or the controller was lost.
    std::uint64_t dropped = 0;   ///< Were never handed to the bridge, mostly for their end.
    std::uint64_t resent = 0;    ///< Records sent again.
  };

  /// @param in_order OpenOptions::in_order.
  explicit DownFrames(bool in_order = false) : order_(in_order) {}

  /// Accepts frames as long as their lanes have room, and it is their turn.
  /// @param end not before that of those that wait. Time::max(): none.
  /// @return how many: up to the first for which that is not so.
  std::size_t offer(std::span<const Frame> frames, Time end);

  /// Another session: what has a number is unknown from now on, what waits goes on waiting.
  void begin();
  /// Drops what waits.
  void drop_waiting();
  /// Drops what has waited until its end.
  void drop_expired(Time now);
  /// When drop_expired() has something to do; Time::max(): never.
  [[nodiscard]] Time next_end() const;

  struct Numbered {
    const Frame& frame;
    std::uint8_t sequence;
    Time end;
  };
  /// The next frame to be sent, if there is one, and the window and the bridge's buffer have room.
  std::optional<Numbered> next();
  /// The sequence that next() will give.
  [[nodiscard]] std::uint8_t sequence() const { return static_cast<std::uint8_t>(cursor_); }

  enum class Progress : std::uint8_t {
    none,      ///< What was known already.
    some,      ///< Frames were taken, or their outcome is known now.
    nonsense,  ///< It tells of frames that were never sent; nothing was changed.
  };
  Progress results(std::uint8_t next, std::uint32_t slots);

  /// next() starts over from the first frame that the bridge has not taken.
  void go_back() { cursor_ = taken_; }
  /// Whether frames have been sent and not been taken.
  [[nodiscard]] bool awaits_taking() const { return cursor_ > taken_; }
  /// Whether the outcome of any frame with a number is still to come.
  [[nodiscard]] bool awaits_outcome() const { return pending_ > 0; }
  [[nodiscard]] std::size_t waiting() const { return lanes_[0].size() + lanes_[1].size(); }
  /// How many wait, or have an outcome to come.
  [[nodiscard]] std::size_t unsettled() const { return pending_ + waiting(); }
  /// Whether nothing waits and all outcomes are known.
  [[nodiscard]] bool done() const { return unsettled() == 0; }
  /// Bytes of records that were sent and are not taken yet.
  [[nodiscard]] std::size_t untaken() const;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct Waiting {
    Frame frame;
    Time end;
  };
  struct Slot {
    Frame frame{};
    Time end{0};
    bool pending = false;
  };
  using Lane = std::deque<Waiting>;
  static std::size_t slot_of(std::uint64_t number) { return number % window; }

  bool settle(Slot& slot, Outcome outcome);
  Lane* waiting_lane();

  std::array<Lane, lane_count> lanes_;
  LaneOrder order_;
  std::array<Slot, window> slots_;
  std::size_t pending_ = 0;     // of slots_
  std::uint64_t taken_ = 0;     // by the bridge: all before this number
  std::uint64_t cursor_ = 0;    // the number to be sent next
  std::uint64_t assigned_ = 0;  // the number that the next new frame gets
  Counters counters_;
};

}  // namespace roio::serial

#endif
