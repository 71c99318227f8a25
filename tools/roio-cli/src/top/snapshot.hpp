/// What `roio-cli top` knows of a bus at one moment.
#ifndef ROIO_CLI_SNAPSHOT_HPP
#define ROIO_CLI_SNAPSHOT_HPP

#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string>
#include <vector>

#include "top/traffic_table.hpp"

namespace roio::cli {

struct Snapshot {
  std::string bus;
  BusState state = BusState::active;
  std::optional<std::uint32_t> bitrate_bps;
  Load load;
  std::uint64_t frames = 0;  ///< Since the beginning, or `clear`; as all that follow.
  std::uint64_t lost = 0;    ///< Frames that were due to us and did not come.
  std::uint64_t errors = 0;  ///< Error reports of the controller.
  std::uint64_t bus_offs = 0;
  std::uint64_t outages = 0;
  std::uint64_t overruns = 0;   ///< Reports of a controller that it lost frames, how many unsaid.
  std::uint64_t fd_frames = 0;  ///< CAN FD frames, which have no rows.
  std::uint64_t rowless = 0;    ///< Frames for whose rows there was no room.
  std::vector<TrafficRow> rows;
  Timestamp time;
};

}  // namespace roio::cli

#endif
