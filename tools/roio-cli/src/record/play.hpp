/// `roio-cli play`: sends what a log has, when the log says.
#ifndef ROIO_CLI_PLAY_HPP
#define ROIO_CLI_PLAY_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string>

#include "record/play_window.hpp"
#include "record/route_words.hpp"
#include "record/schedule.hpp"

namespace roio::cli {

struct PlayOptions {
  std::string file;  ///< "-": standard input.
  Routes routes;
  PlayPace pace;
  std::uint64_t times = 1;  ///< How often the log is played; 0: until a signal.
  std::optional<LogTime> from;
  std::optional<LogTime> to;
  std::chrono::milliseconds timeout{1000};  ///< Of each frame.
  /// How long to wait, first, until somebody listens on the local buses.
  std::optional<std::chrono::milliseconds> wait;
};

/// @return the exit status; 1 when a line of the log could not be understood.
/// @throws UsageError, Failure (not sent in time, nothing to send), std::system_error.
int play(const PlayOptions& options);

}  // namespace roio::cli

#endif
