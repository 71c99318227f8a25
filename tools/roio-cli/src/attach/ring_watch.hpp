/// RingWatch: notices frames that go round. Two buses that are joined by something else, too, that
/// nobody knew of, hand each frame back and forth for ever. Pure: frames and the time go in.
///
/// A bus does not give us what we sent to it. A frame that comes from it, and is the same as one
/// that we sent to it a moment ago, may have gone round once. When nearly all have, many times in a
/// row, it is a storm. A bridge in loopback mode hands back each frame once, and is none.
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

/// Any thread may call it.
class RingWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// What is older has not gone round.
  static constexpr std::chrono::seconds memory{1};
  /// So often in a row, at least, a frame of a storm has gone round.
  static constexpr std::uint32_t storm_rounds = 16;
  /// So many of them, at least, come in a second.
  static constexpr std::uint64_t storm_frames = 30;

  RingWatch();

  /// Frames came from one bus, 0 or 1, and go to the other now.
  /// @return false: a storm.
  bool pass(std::size_t from, std::span<const Frame> frames, Clock::time_point now);

 private:
  /// Frames of one content that were sent to a bus and have not come back from it.
  struct Slot {
    std::uint64_t content = 0;
    std::uint32_t count = 0;
    std::uint32_t rounds = 0;  // the most of them
    Clock::time_point time;
  };
  using Memory = std::vector<Slot>;  // of slot_count, by content

  static std::uint32_t rounds_of(Memory& sent_to_it, std::uint64_t content, Clock::time_point now);
  static void remember(Memory& sent_to_it, std::uint64_t content, std::uint32_t rounds,
                       Clock::time_point now);

  std::mutex mutex_;
  std::array<Memory, 2> sent_to_;
  Clock::time_point second_begins_;  // of what is counted here
  std::uint64_t frames_ = 0;
  std::uint64_t gone_round_ = 0;
};

}  // namespace roio::cli

#endif
