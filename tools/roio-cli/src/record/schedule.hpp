/// When the frames of a log are due. Pure: the time goes in.
#ifndef ROIO_CLI_SCHEDULE_HPP
#define ROIO_CLI_SCHEDULE_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>

namespace roio::cli {

struct PlayPace {
  /// Times the log's own; none: as fast as the bus takes them.
  std::optional<double> speed = 1.0;
  /// A pause that would be longer is cut to this.
  std::optional<std::chrono::nanoseconds> longest_pause{};
};

class Schedule {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Schedule(const PlayPace& pace) : pace_(pace) {}

  /// @param time of the next frame in the log; none: it has none, and follows the one before.
  /// @param now when the first is due.
  /// @return when it is due: never before the one before it.
  Clock::time_point due(std::optional<Timestamp> time, Clock::time_point now);

  /// The log begins again; its first frame follows the last one.
  void begin_again() { last_time_.reset(); }

  /// Times that the log's time went back by more than a log of several buses may be out of order.
  [[nodiscard]] std::uint64_t steps_back() const { return steps_back_; }

 private:
  /// From now on, `time` in the log is `due` here.
  void set_reference(Timestamp time, Clock::time_point due);
  [[nodiscard]] std::chrono::nanoseconds at_pace(std::chrono::nanoseconds in_log) const;

  PlayPace pace_;
  std::optional<Timestamp> last_time_;
  Timestamp reference_time_{};
  Clock::time_point reference_due_{};
  std::optional<Clock::time_point> last_due_;
  std::uint64_t steps_back_ = 0;
};

}  // namespace roio::cli

#endif
