/// `roio-cli gen`: numbered messages, at a given share of the bus.
#ifndef ROIO_CLI_GEN_HPP
#define ROIO_CLI_GEN_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "gen/traffic.hpp"

namespace roio::cli {

struct GenOptions {
  std::string bus;
  TrafficOptions traffic;
  std::optional<double> load;                ///< Share of the bus, 0..1.
  std::optional<std::uint64_t> rate;         ///< Messages a second; neither: as fast as it goes.
  std::optional<std::uint32_t> bitrate_bps;  ///< None: as the bus itself tells.
  std::optional<std::uint64_t> count;
  std::optional<std::chrono::milliseconds> time;
  std::chrono::milliseconds timeout{1000};  ///< Of each message.
};

/// @return the exit status. @throws UsageError, Failure (not sent in time), std::system_error.
int gen(const GenOptions& options);

}  // namespace roio::cli

#endif
