#ifndef ROIO_PARTS_DEADLINE_HPP
#define ROIO_PARTS_DEADLINE_HPP

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <roio/bus.hpp>

namespace roio {

/// A point in time by which a wait must end, from a timeout that may be `forever`. So a wait that
/// is woken for nothing goes on for what is left of its time. By the steady clock: nobody sets it.
/// A value without change: any number of threads may ask it. No errors.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// Begins now. @param timeout negative counts as zero; a hundred years and more as `forever`.
  explicit Deadline(Timeout timeout)
      : at_(timeout >= far_away ? Clock::time_point::max()
                                : Clock::now() + std::max(timeout, no_wait)) {}

  [[nodiscard]] bool never() const { return at_ == Clock::time_point::max(); }
  /// Zero once it has passed; `forever` when it never does.
  [[nodiscard]] Timeout remaining() const {
    return never() ? forever : std::max<Timeout>(no_wait, at_ - Clock::now());
  }
  [[nodiscard]] bool passed() const { return !never() && Clock::now() >= at_; }
  /// time_point::max(): never.
  [[nodiscard]] Clock::time_point at() const { return at_; }

  /// For poll(): whole milliseconds, rounded up so that a wait does not spin at its end; -1 for
  /// never. A day at most: after poll() has returned 0, ask passed().
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
