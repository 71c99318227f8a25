#include "socketcan/errors.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace roio::socketcan {
namespace {

// Older kernel headers (before 6.0) lack these names.
constexpr std::uint32_t counters_valid = 0x200;  // CAN_ERR_CNT
constexpr std::uint8_t warning_level = 96;       // CAN_ERROR_WARNING_THRESHOLD
constexpr std::uint8_t passive_level = 128;      // CAN_ERROR_PASSIVE_THRESHOLD
constexpr std::size_t controller_byte = 1;       // CAN_ERR_CRTL_*
constexpr std::size_t transmit_errors_byte = 6;
constexpr std::size_t receive_errors_byte = 7;

std::optional<BusState> state_from_flags(std::uint8_t flags) {
  if ((flags & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    return BusState::passive;
  }
  if ((flags & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
    return BusState::warning;
  }
  if ((flags & CAN_ERR_CRTL_ACTIVE) != 0) {
    return BusState::active;
  }
  return std::nullopt;
}

BusState state_from_counters(const Frame& frame) {
  const std::uint8_t highest =
      std::max(frame.data[transmit_errors_byte], frame.data[receive_errors_byte]);
  if (highest >= passive_level) {
    return BusState::passive;
  }
  return highest >= warning_level ? BusState::warning : BusState::active;
}

BusState state_after(const Frame& frame, BusState before) {
  if ((frame.id & CAN_ERR_BUSOFF) != 0) {
    return BusState::bus_off;
  }
  if ((frame.id & CAN_ERR_RESTARTED) != 0) {
    return BusState::active;
  }
  if ((frame.id & CAN_ERR_CRTL) != 0) {
    if (const auto state = state_from_flags(frame.data[controller_byte])) {
      return *state;
    }
  }
  // The counters read 0 to 255 in bus-off too, so they cannot end it.
  if ((frame.id & counters_valid) != 0 && before != BusState::bus_off) {
    return state_from_counters(frame);
  }
  return before;
}

}  // namespace

ErrorReport decode_error_report(const Frame& frame, BusState before) noexcept {
  const bool controller = (frame.id & CAN_ERR_CRTL) != 0;
  return {state_after(frame, before), (frame.id & CAN_ERR_BUSOFF) != 0,
          controller && (frame.data[controller_byte] & CAN_ERR_CRTL_RX_OVERFLOW) != 0};
}

}  // namespace roio::socketcan
