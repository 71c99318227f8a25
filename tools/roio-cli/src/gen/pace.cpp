#include "gen/pace.hpp"

#include <algorithm>

namespace roio::cli {

void Pace::spend(double units, Clock::time_point now) {
  const double ns = units / per_s_ * 1e9 + left_over_ns_;
  const auto whole = std::chrono::nanoseconds(static_cast<std::int64_t>(ns));
  left_over_ns_ = ns - static_cast<double>(whole.count());
  next_ = std::max(next_ + whole, now - most_behind);
}

}  // namespace roio::cli
