#ifndef ROIO_PARTS_DEADLINE_HPP
#define ROIO_PARTS_DEADLINE_HPP

#include <algorithm>
#include <chrono>
#include <roio/bus.hpp>

namespace roio {

/// A point in time by which a wait must end, from a timeout that may be `forever`.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Deadline(Timeout timeout)
      : at_(timeout >= far_away ? Clock::time_point::max()
                                : Clock::now() + std::max(timeout, no_wait)) {}

  [[nodiscard]] bool never() const { return at_ == Clock::time_point::max(); }
  [[nodiscard]] Timeout remaining() const {
    return never() ? forever : std::max<Timeout>(no_wait, at_ - Clock::now());
  }
  [[nodiscard]] bool passed() const { return !never() && Clock::now() >= at_; }
  [[nodiscard]] Clock::time_point at() const { return at_; }

  /// For poll(): whole milliseconds, rounded up so that a wait does not spin at its end; -1 for
  /// never.
  [[nodiscard]] int poll_ms() const {
    if (never()) {
      return -1;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(remaining()).count();
    return static_cast<int>(std::min<decltype(left)>(left, max_poll_ms));
  }

 private:
  // Beyond this, adding to now() could overflow; a program does not outlive it.
  static constexpr Timeout far_away = std::chrono::hours(24 * 365 * 100);
  static constexpr std::int64_t max_poll_ms = 24L * 60 * 60 * 1000;

  Clock::time_point at_;
};

}  // namespace roio

#endif
