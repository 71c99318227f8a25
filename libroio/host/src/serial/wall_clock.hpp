#ifndef ROIO_SERIAL_WALL_CLOCK_HPP
#define ROIO_SERIAL_WALL_CLOCK_HPP

#include <chrono>
#include <roio/bus.hpp>

#include "serial/clock.hpp"

namespace roio::serial {

/// The steady clock's time as wall-clock time; it goes back only when somebody sets the clock back.
class WallClock {
 public:
  /// @param time of the steady clock, since its epoch.
  Timestamp at(Time time) {
    const Timestamp now = std::chrono::system_clock::now();
    const std::chrono::nanoseconds offset =
        now.time_since_epoch() - std::chrono::steady_clock::now().time_since_epoch();
    if (!known_ || std::chrono::abs(offset - offset_) > step) {
      known_ = true;
      offset_ = offset;
    }
    return Timestamp(time + offset_);
  }

 private:
  static constexpr std::chrono::milliseconds step{50};  // that somebody has set the clock by

  bool known_ = false;
  std::chrono::nanoseconds offset_{0};
};

}  // namespace roio::serial

#endif
