#include "bridge/bridge.hpp"

#include <roio/bus.hpp>
#include <utility>

#include "bridge/report.hpp"
#include "program/exit_status.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

/// A bridge that is only spoken with: no frame comes in.
class OpenBridge {
 public:
  explicit OpenBridge(const std::string& port)
      : bus_(open(port, OpenOptions{.send_only = true})), bridge_(*bridge_of(*bus_)) {}

  Bridge* operator->() const { return &bridge_; }

 private:
  std::unique_ptr<Bus> bus_;
  Bridge& bridge_;
};

}  // namespace

int bridge_show(const BridgeShowOptions& options) {
  const OpenBridge bridge(options.port);
  // The answer to this one brings the state, too.
  const BridgeCounters counters = bridge->counters();
  const BridgeReport report{bridge->info(), counters, bridge->line_counters()};
  Buffer out;
  if (options.json) {
    append_json(out, report);
  } else {
    append_text(out, report);
  }
  flush(out);
  return exit_success;
}

int bridge_set(const BridgeSetOptions& options) {
  const OpenBridge bridge(options.port);
  if (options.bitrate_bps || options.mode) {
    bridge->set_bus(options.bitrate_bps.value_or(0), options.mode.value_or(bridge->info().mode));
  }
  if (options.set_address) {
    bridge->set_address(options.address);
  }
  return exit_success;
}

int bridge_identify(const BridgeIdentifyOptions& options) {
  const OpenBridge bridge(options.port);
  bridge->identify(options.duration);
  return exit_success;
}

}  // namespace roio::cli
