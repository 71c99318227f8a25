/// RingWatch: notices frames that go round. Two buses that are joined by something else, too, that
/// nobody knew of, hand each frame back and forth for ever. Pure: frames and the time go in.
///
/// A bus does not give us what we sent to it. A frame that comes from it, and is the same as one
/// that we sent to it a moment ago, may have gone round once. When nearly all have, many times in a
/// row, and more often than anybody sends one and the same message, it is a storm. Two nodes that
/// say the same on both sides, every so often, are none.
#ifndef ROIO_CLI_RING_WATCH_HPP
#define ROIO_CLI_RING_WATCH_HPP

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <roio/frame.hpp>
#include <span>
#include <vector>

namespace roio::cli {

/// The rounds that are no longer than a turnaround, and whether they are a storm.
class RoundCount {
 public:
  using Clock = std::chrono::steady_clock;

  /// So often in a row, at least, a frame of a storm has gone round.
  static constexpr std::uint32_t storm_rounds = 16;

  /// @param turnaround what comes back later has not gone round.
  /// @param storm_frames so many that have gone round, at least, come in a second of a storm.
  /// @param contents many times as many as may go round at a time.
  RoundCount(Clock::duration turnaround, std::uint64_t storm_frames, std::size_t contents);

  /// A frame came from one bus, 0 or 1, and goes to the other now.
  void pass(std::size_t from, std::uint64_t content, Clock::time_point now);
  [[nodiscard]] bool is_storm() const;

 private:
  /// Frames of one content that were sent to a bus and have not come back from it.
  struct Slot {
    std::uint64_t content = 0;
    std::uint32_t count = 0;
    std::uint32_t rounds = 0;  // the most of them
    Clock::time_point time;
  };
  using Memory = std::vector<Slot>;  // by content

  std::uint32_t rounds_of(Memory& sent_to_it, std::uint64_t content, Clock::time_point now) const;
  void remember(Memory& sent_to_it, std::uint64_t content, std::uint32_t rounds,
                Clock::time_point now) const;

  Clock::duration turnaround_;
  std::uint64_t storm_frames_;
  std::array<Memory, 2> sent_to_;
  Clock::time_point second_begins_;  // of what is counted here
  std::uint64_t frames_ = 0;
  std::uint64_t gone_round_ = 0;
};

/// Any thread may call it.
class RingWatch {
 public:
  using Clock = RoundCount::Clock;

  /// A few frames go round as fast as they can: in a fraction of a millisecond on local buses, in
  /// some where bridges are on the way. Whoever sends one message in cycles takes longer.
  static constexpr std::chrono::milliseconds quick_turnaround{10};
  static constexpr std::uint64_t quick_frames = 300;
  static constexpr std::size_t quick_contents = 4096;
  /// Where many go round each waits for the others; together they are a flood.
  static constexpr std::chrono::milliseconds flood_turnaround{200};
  static constexpr std::uint64_t flood_frames = 5000;
  static constexpr std::size_t flood_contents = 65536;

  /// Frames came from one bus, 0 or 1, and go to the other now.
  /// @return false: a storm.
  bool pass(std::size_t from, std::span<const Frame> frames, Clock::time_point now);

 private:
  std::mutex mutex_;
  RoundCount quick_{quick_turnaround, quick_frames, quick_contents};
  RoundCount flood_{flood_turnaround, flood_frames, flood_contents};
};

}  // namespace roio::cli

#endif
