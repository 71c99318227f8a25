#ifndef ROIO_SERIAL_CONTROLLER_WATCH_HPP
#define ROIO_SERIAL_CONTROLLER_WATCH_HPP

#include <cstdint>
#include <optional>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/frame.hpp>
#include <roio/parts/controller_report.hpp>

namespace roio::serial {

BusState bus_state(BridgeState state);

/// What happens to the controller, told by the bridge's counters: as SocketCAN's drivers do it.
/// They come at once after a change of the state, and else once in a second.
class ControllerWatch {
 public:
  struct News {
    Frame report;  ///< Of FrameKind::error.
    std::uint64_t overruns;
    std::uint64_t bus_offs;
  };
  /// COUNTERS has come. None: nothing has happened since the one before, or this is the first.
  std::optional<News> take(const BridgeCounters& counters, const BridgeInfo& info);

 private:
  std::optional<BridgeCounters> counters_;  // as they were last
  ControllerView view_;
};

}  // namespace roio::serial

#endif
