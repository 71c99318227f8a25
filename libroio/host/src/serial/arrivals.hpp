/// Arrivals: frames from the bridge as they come: once each, with the time at which the bridge read
/// them, and what was lost before them. Source: docs/internals/serial-protocol.md "Up".
#ifndef ROIO_SERIAL_ARRIVALS_HPP
#define ROIO_SERIAL_ARRIVALS_HPP

#include <cstdint>
#include <roio/frame.hpp>
#include <span>
#include <utility>
#include <vector>

#include "serial/clock.hpp"
#include "serial/up.hpp"

namespace roio::serial {

struct Arrived {
  Frame frame;
  Time time;                  ///< When the bridge read it, by the clock of `now`.
  std::uint64_t lost_before;  ///< Frames due that did not come, between the one before and this.
};

class Arrivals {
 public:
  /// Another session.
  void begin();
  /// How many frames were due in the session before, which this side had as well: to be told before
  /// begin().
  void settle_last(std::uint32_t due) { static_cast<void>(up_.settle(due)); }

  /// A frame's record. @param body all of it, of which @param frame was read.
  /// @return false: the line repeats it, and nothing was changed.
  bool take(const Frame& frame, std::span<const std::uint8_t> body, Time now);
  /// Any other record says which frame is the next.
  void expect(std::uint8_t sequence) { up_.expect(sequence); }

  enum class Told : std::uint8_t {
    sense,
    nonsense,     ///< Time or count go back: a record that the line repeats.
    other_board,  ///< Twice in a row: a board that was reset, brought into this session by HELLO.
  };
  /// STATUS. @param ticks the bridge's time. @param due frames due in this session.
  Told status(std::uint32_t ticks, std::uint32_t due, Time now);

  /// What has arrived since the last call.
  std::vector<Arrived> take_all() { return std::exchange(arrived_, {}); }
  /// Losses so far are not told with the next frame.
  void forget_losses() { lost_told_ = up_.lost(); }
  /// Frames due that did not come, in all sessions.
  [[nodiscard]] std::uint64_t lost() const { return up_.lost(); }

 private:
  static constexpr unsigned max_impossible = 2;

  UpCount up_;
  RepeatedFrames repeated_;
  BridgeClock clock_;
  unsigned impossible_ = 0;  // STATUS in a row
  std::uint64_t lost_told_ = 0;
  std::vector<Arrived> arrived_;
};

}  // namespace roio::serial

#endif
