/// `roio-cli top`: who is on a bus, live.
#ifndef ROIO_CLI_TOP_HPP
#define ROIO_CLI_TOP_HPP

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/robot.hpp>
#include <string>

namespace roio::cli {

struct TopOptions {
  std::string bus;
  std::shared_ptr<const Robot> robot;        ///< Whose names hold; null: none.
  std::optional<std::uint32_t> bitrate_bps;  ///< None: as the bus itself tells, if it does.
  /// From one drawing, or one set of lines, to the next; none: what suits them.
  std::optional<std::chrono::milliseconds> interval;
  std::optional<std::uint64_t> count;  ///< End after so many intervals.
  bool json = false;                   ///< Lines, also on a terminal.
};

/// @return the exit status. @throws UsageError, Failure, BrokenPipe, std::system_error.
int top(const TopOptions& options);

}  // namespace roio::cli

#endif
