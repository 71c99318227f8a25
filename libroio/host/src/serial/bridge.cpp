#include <roio/bridge.hpp>

#include "parts/fork.hpp"

namespace roio {

const char* to_string(BridgeBoard board) noexcept {
  switch (board) {
    case BridgeBoard::uno:
      return "uno";
    case BridgeBoard::leonardo:
      return "leonardo";
    case BridgeBoard::mega:
      return "mega";
    case BridgeBoard::other:
      break;
  }
  return "other";
}

const char* to_string(BridgeMode mode) noexcept {
  switch (mode) {
    case BridgeMode::listen:
      return "listen";
    case BridgeMode::loopback:
      return "loopback";
    case BridgeMode::normal:
      break;
  }
  return "normal";
}

const char* to_string(BridgeState state) noexcept {
  switch (state) {
    case BridgeState::active:
      return "error-active";
    case BridgeState::warning:
      return "error-warning";
    case BridgeState::passive:
      return "error-passive";
    case BridgeState::bus_off:
      return "bus-off";
    case BridgeState::no_controller:
      return "no controller";
    case BridgeState::stuck:
      return "bus stuck";
    case BridgeState::absent:
      break;
  }
  return "absent";
}

std::string to_string(const FirmwareVersion& version) {
  return std::to_string(version.major) + '.' + std::to_string(version.minor) + '.' +
         std::to_string(version.patch);
}

Bridge* bridge_of(Bus& bus) noexcept {
  return dynamic_cast<Bridge*>(bus_itself(bus));
}

}  // namespace roio
