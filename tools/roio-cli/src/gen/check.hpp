/// `roio-cli gen --check`: what became of numbered messages.
#ifndef ROIO_CLI_CHECK_HPP
#define ROIO_CLI_CHECK_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace roio::cli {

struct CheckOptions {
  std::string bus;
  std::optional<std::uint64_t> count;                   ///< End after so many received.
  std::optional<std::chrono::milliseconds> time;        ///< End after so long.
  std::optional<std::chrono::milliseconds> quiet_time;  ///< End after so long without one.
  bool verbose = false;
};

/// @return the exit status; 1 when any were lost, doubled or out of order, when none came, or fewer
///         than the count.
/// @throws UsageError, Failure, BrokenPipe, std::system_error.
int check(const CheckOptions& options);

}  // namespace roio::cli

#endif
