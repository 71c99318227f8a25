#include "serial/controller_watch.hpp"

#include <utility>

namespace roio::serial {
namespace {

/// Of a counter of 32 bits, which begins anew when the board is reset.
std::uint32_t growth(std::uint32_t before, std::uint32_t now) {
  return now >= before ? now - before : now;
}

/// The state and the error counters as they are now; while the bridge has no controller, as they
/// were last.
ControllerView view_after(ControllerView view, const BridgeInfo& info) {
  const BusState state = bus_state(info.state);
  if (state != BusState::down && state != BusState::absent) {
    view.state = state;
  }
  view.transmit_errors = info.transmit_errors;
  view.receive_errors = info.receive_errors;
  return view;
}

}  // namespace

BusState bus_state(BridgeState state) {
  switch (state) {
    case BridgeState::active:
      return BusState::active;
    case BridgeState::warning:
      return BusState::warning;
    case BridgeState::passive:
      return BusState::passive;
    case BridgeState::bus_off:
      return BusState::bus_off;
    case BridgeState::no_controller:
    case BridgeState::stuck:
      return BusState::down;
    case BridgeState::absent:
      break;
  }
  return BusState::absent;
}

std::optional<ControllerWatch::News> ControllerWatch::take(const BridgeCounters& counters,
                                                           const BridgeInfo& info) {
  const auto before = std::exchange(counters_, counters);
  const ControllerView last = std::exchange(view_, view_after(view_, info));
  if (!before) {
    return std::nullopt;
  }
  view_.overruns += growth(before->overflows, counters.overflows);
  view_.bus_offs += growth(before->bus_offs, counters.bus_offs);
  view_.message_errors += growth(before->message_errors, counters.message_errors);
  if (!is_news(last, view_)) {
    return std::nullopt;
  }
  return News{error_report(last, view_), view_.overruns - last.overruns,
              view_.bus_offs - last.bus_offs};
}

}  // namespace roio::serial
