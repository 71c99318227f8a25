/// Pace: when the next message may go, for so many a second, or for a share of the bus. Pure: the
/// time goes in.
#ifndef ROIO_CLI_PACE_HPP
#define ROIO_CLI_PACE_HPP

#include <chrono>

namespace roio::cli {

class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// Whoever falls further behind than this does not catch up: a bus that was held up is not
  /// flooded afterwards.
  static constexpr std::chrono::milliseconds most_behind{100};

  /// @param per_s units a second: messages, or bits; above 0.
  Pace(double per_s, Clock::time_point start) : per_s_(per_s), next_(start) {}

  /// When the next message is due.
  [[nodiscard]] Clock::time_point next() const { return next_; }

  /// A message is sent, of so many units: those after it are so much later.
  void spend(double units, Clock::time_point now);

 private:
  double per_s_;
  Clock::time_point next_;
  double left_over_ns_ = 0;  // of a nanosecond, so that no rounding adds up
};

}  // namespace roio::cli

#endif
