#include "buses/buses.hpp"

#include <algorithm>
#include <roio/bridge.hpp>
#include <roio/bus_list.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "bridge/report.hpp"
#include "program/exit_status.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

BusReport report_of(const CanInterface& interface) {
  BusReport report{.bus = interface.name, .kind = "can"};
  report.state = to_string(interface.state);
  report.bitrate_bps = interface.bitrate_bps;
  report.interface_kind = interface.kind;
  return report;
}

BusReport report_of(const BridgePort& port) {
  BusReport report{.bus = "serial:" + port.path, .kind = "serial"};
  if (!port.product.empty()) {
    report.product = port.product;
  }
  if (!port.bridge) {
    report.why_not = port.why_not;
    return report;
  }
  report.state = to_string(port.bridge->state);
  report.bitrate_bps = port.bridge->bitrate_bps;
  report.board = to_string(port.bridge->board);
  report.firmware = to_string(port.bridge->firmware);
  return report;
}

BusReport report_of(const std::string& local_bus) {
  return {.bus = local_bus, .kind = "local"};
}

struct Search {
  std::vector<BusReport> found;
  bool failed = false;

  /// Where one kind of bus cannot be looked for, the others still can.
  template <typename List>
  void add(const char* what, const List& list) {
    try {
      for (const auto& bus : list()) {
        found.push_back(report_of(bus));
      }
    } catch (const std::system_error& error) {
      note(std::string(what) + ": " + error.what());
      failed = true;
    }
  }
};

Search look_for_buses() {
  Search search;
  search.add("CAN interfaces", can_interfaces);
  search.add("local buses", local_buses);
  search.add("serial ports", [] { return find_bridges(); });
  return search;
}

void say_what_to_do() {
  note(
      "no CAN interface: plug in an adapter, or `ip link add vcan0 type vcan; ip link set vcan0 "
      "up` makes a virtual one");
  note("no local bus: `roio-cli dump local:robot` makes one");
  note(
      "no serial port with a bridge: plug in an Arduino with the bridge_usb firmware, or name its "
      "port in ROIO_SERIAL_PORTS");
}

}  // namespace

int buses(const BusesOptions& options) {
  const auto& [found, failed] = look_for_buses();
  const int status = failed ? exit_failure : exit_success;
  if (found.empty()) {
    if (!failed) {
      say_what_to_do();
    }
    return status;
  }
  std::size_t width = 0;
  for (const BusReport& report : found) {
    width = std::max(width, report.bus.size());
  }
  Buffer out;
  for (const BusReport& report : found) {
    if (options.json) {
      append_json(out, report);
    } else {
      append_text(out, report, width);
    }
  }
  flush(out);
  return status;
}

}  // namespace roio::cli
