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

/// Received frames that wait for the program, each with what was lost before it. Not for two
/// threads at once, but for readable().
class ReceiveQueue {
 public:
  explicit ReceiveQueue(std::size_t capacity) : capacity_(capacity) {}

  /// The oldest, as many as there are and there is room for.
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

  /// One that finds no room is lost, and counted.
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
  /// Frames lost elsewhere, which are told with the next.
  void lose(std::uint64_t count) { lost_ += count; }
  /// As if nothing had ever come.
  void forget() {
    queue_.clear();
    readable_.clear();
    lost_ = received_ = dropped_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return queue_.size(); }
  /// Set while frames wait.
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
