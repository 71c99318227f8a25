#include "pace.hpp"

namespace roio::sim_tool {

sim::SimTime Pace::due(Clock::time_point now, sim::SimTime simulated) {
  using std::chrono::duration_cast;
  constexpr sim::SimTime no_pace = std::chrono::milliseconds(1);
  if (speed_ == 0) {
    return simulated + no_pace;
  }
  const auto real = duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::chrono::duration<double>(simulated).count() / speed_));
  const Clock::duration late = (now - start_ - behind_) - real;
  if (late > most_behind) {
    behind_ += late - most_behind;
  }
  // Nanoseconds are fine enough, and 0.1 s times 10 is to be a second.
  return std::chrono::round<std::chrono::nanoseconds>(
      std::chrono::duration<double>(now - start_ - behind_) * speed_);
}

}  // namespace roio::sim_tool
