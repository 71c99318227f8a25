#ifndef ROIO_PARTS_RECEIVE_QUEUE_HPP
#define ROIO_PARTS_RECEIVE_QUEUE_HPP

#include <algorithm>
#include <cstdint>
#include <deque>
#include <roio/bus.hpp>
#include <roio/parts/fd.hpp>
#include <span>
#include <utility>

namespace roio {

/// Received frames that wait for the program, each with what was lost before it. Bounded: a frame
/// that finds no room is dropped, counted, and told with the next one that finds room.
///
/// Not for two threads at once, but for readable(): the backend's lock is held for everything else.
/// Takes no memory before frames come.
class ReceiveQueue {
 public:
  /// @param capacity how many frames may wait; above 0.
  /// @throws std::system_error: no descriptors left.
  explicit ReceiveQueue(std::size_t capacity) : capacity_(capacity) {}

  /// Moves the oldest to `frames`, as many as there are and there is room for. The last one clears
  /// readable(). @return how many.
  std::size_t take(std::span<Received> frames) {
    const std::size_t count = std::min(frames.size(), queue_.size());
    const auto end = queue_.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(queue_.begin(), end, frames.begin());
    received_ +=
        static_cast<std::uint64_t>(std::count_if(queue_.begin(), end, [](const Received& received) {
          return received.frame.kind != FrameKind::error;
        }));
    queue_.erase(queue_.begin(), end);
    if (queue_.empty()) {
      readable_.clear();
    }
    return count;
  }

  /// A frame that has come, after filters. The first sets readable(). One that finds no room is
  /// dropped and counted.
  /// @param time when it was on the bus.
  void put(const Frame& frame, Timestamp time) {
    if (queue_.size() >= capacity_) {
      ++dropped_;
      ++lost_;
      return;
    }
    queue_.push_back({frame, time, std::exchange(lost_, 0)});
    if (queue_.size() == 1) {
      readable_.set();
    }
  }
  /// Frames lost elsewhere, before they came here: told with the next frame, but not counted by
  /// add_to(), since whoever knows of them counts them.
  void lose(std::uint64_t count) { lost_ += count; }
  /// As if nothing had ever come: for what was received before open() returns.
  void forget() {
    queue_.clear();
    readable_.clear();
    lost_ = received_ = dropped_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return queue_.size(); }
  /// Set while frames wait. Its descriptor is the one for Bus::fd().
  [[nodiscard]] const EventFlag& readable() const { return readable_; }
  /// Adds what it has counted: received without error reports, dropped for want of room.
  void add_to(Statistics& statistics) const {
    statistics.received += received_;
    statistics.dropped += dropped_;
  }

 private:
  const std::size_t capacity_;
  EventFlag readable_;
  std::deque<Received> queue_;
  std::uint64_t lost_ = 0;  // not yet told with a frame
  std::uint64_t received_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace roio

#endif
