/// The counters of a bridge, in groups, under the names that users read.
#ifndef ROIO_CLI_BRIDGE_COUNTS_HPP
#define ROIO_CLI_BRIDGE_COUNTS_HPP

#include <array>

#include "bridge/report.hpp"

namespace roio::cli {

inline std::array<Count, 3> counts_up(const BridgeCounters& board) {
  return {{
      {"dropped", "frames lost in the bridge, the line being full", board.dropped},
      {"overflows", "times the controller lost frames", board.overflows},
      {"discarded", "frames from the controller that were none", board.discarded},
  }};
}

inline std::array<Count, 5> counts_down(const BridgeCounters& board) {
  return {{
      {"sent", "frames sent and acknowledged", board.sent},
      {"notSent", "frames given up", board.not_sent},
      {"unknown", "frames the controller was restarted under", board.unknown},
      {"damaged", "damaged records, repeated", board.damaged},
      {"overruns", "bytes lost for coming too fast", board.overruns},
  }};
}

inline std::array<Count, 3> counts_of_controller(const BridgeCounters& board) {
  return {{
      {"messageErrors", "errors found in frames", board.message_errors},
      {"busOffs", "times bus-off", board.bus_offs},
      {"chipLosses", "times it was lost and started anew", board.chip_losses},
  }};
}

inline std::array<Count, 7> counts_of_line(const BridgeLineCounters& line) {
  return {{
      {"sessions", "sessions with the bridge", line.sessions},
      {"lost", "frames from the bridge that did not come", line.lost},
      {"damaged", "damaged records from the bridge", line.damaged},
      {"resent", "frames to the bridge repeated", line.resent},
      {"retries", "requests to the bridge repeated", line.retries},
      {"failedTrials", "line rates that failed the trial", line.failed_trials},
      {"stepDowns", "times the line rate was lowered", line.step_downs},
  }};
}

}  // namespace roio::cli

#endif
