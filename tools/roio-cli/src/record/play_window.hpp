/// Which part of a log is played: --from and --to. Pure.
#ifndef ROIO_CLI_PLAY_WINDOW_HPP
#define ROIO_CLI_PLAY_WINDOW_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <roio/text.hpp>
#include <string>

namespace roio::cli {

/// A time in a log: as its lines have it, or since its first frame.
struct LogTime {
  std::chrono::nanoseconds time;
  bool since_first;
};

/// "1436509052.25", or "+12.5" since the first.
Parsed<LogTime> parse_log_time(const std::string& text);

class PlayWindow {
 public:
  enum class Place : std::uint8_t {
    inside,
    outside,
    behind,  ///< And so is all that follows, even in a log of several buses.
  };

  PlayWindow(std::optional<LogTime> from, std::optional<LogTime> to) : from_(from), to_(to) {}

  /// @param time of the next frame; none: it has none, and is where the one before it was.
  Place place(std::optional<Timestamp> time);

 private:
  [[nodiscard]] Timestamp absolute(const LogTime& time) const;

  std::optional<LogTime> from_;
  std::optional<LogTime> to_;
  std::optional<Timestamp> first_;
  Place last_ = Place::inside;
};

}  // namespace roio::cli

#endif
