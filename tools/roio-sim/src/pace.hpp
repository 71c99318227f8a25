/// Pace: which simulated time it should be by now. Who cannot keep up does not have to catch up for
/// ever: what lies further back than a moment is given up, and counted.
#ifndef ROIO_SIM_TOOL_PACE_HPP
#define ROIO_SIM_TOOL_PACE_HPP

#include <chrono>
#include <roio/sim/time.hpp>

namespace roio::sim_tool {

class Pace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds most_behind{100};

  /// @param speed times real time; 0: as fast as it goes.
  Pace(double speed, Clock::time_point start) : speed_(speed), start_(start) {}

  /// How far simulated time, which is at `simulated`, should have come.
  [[nodiscard]] sim::SimTime due(Clock::time_point now, sim::SimTime simulated);
  /// Real time given up so far.
  [[nodiscard]] Clock::duration behind() const { return behind_; }

 private:
  double speed_;
  Clock::time_point start_;
  Clock::duration behind_{0};
};

}  // namespace roio::sim_tool

#endif
