#include "serial/reports.hpp"

#include <array>
#include <roio/bit_timing.hpp>

namespace roio::serial {
namespace {

// WELCOME, behind the control head.
constexpr std::size_t session_at = 1;
constexpr std::size_t previous_session_at = 5;
constexpr std::size_t previous_due_at = 9;
constexpr std::size_t firmware_at = 13;
constexpr std::size_t board_at = 16;
constexpr std::size_t flags_at = 17;
constexpr std::size_t window_at = 18;
constexpr std::size_t crystal_at = 19;
constexpr std::size_t bitrate_at = 21;
constexpr std::size_t mode_at = 25;
constexpr std::size_t address_at = 26;
constexpr std::size_t rates_at = 28;
// STATUS
constexpr std::size_t due_at = 4;
constexpr std::size_t state_at = 8;
constexpr std::size_t transmit_errors_at = 9;
constexpr std::size_t receive_errors_at = 10;

std::optional<Address> address_of(const std::uint8_t* bytes) {
  const Address address{bytes[0], bytes[1]};
  return is_broadcast(address) ? std::nullopt : std::optional(address);
}

BridgeBoard board_of(std::uint8_t byte) {
  return byte <= static_cast<std::uint8_t>(BridgeBoard::mega) ? static_cast<BridgeBoard>(byte)
                                                              : BridgeBoard::other;
}

}  // namespace

std::optional<Welcome> read_welcome(std::span<const std::uint8_t> payload) {
  if (payload.size() != welcome_length - control_head || payload[window_at] != window ||
      payload[mode_at] > static_cast<std::uint8_t>(BridgeMode::loopback)) {
    return std::nullopt;
  }
  BridgeInfo info;
  info.firmware = {payload[firmware_at], payload[firmware_at + 1], payload[firmware_at + 2]};
  info.board = board_of(payload[board_at]);
  info.line_rate_matters = (payload[flags_at] & rate_matters) != 0;
  info.interrupt_wired = (payload[flags_at] & interrupt_is_wired) != 0;
  info.osc_khz = get16(&payload[crystal_at]);
  info.bitrate_bps = get32(&payload[bitrate_at]);
  info.mode = static_cast<BridgeMode>(payload[mode_at]);
  info.address = address_of(&payload[address_at]);
  info.state = BridgeState::absent;
  return Welcome{get32(&payload[session_at]), get32(&payload[previous_session_at]),
                 get32(&payload[previous_due_at]), info, payload[rates_at]};
}

std::uint32_t real_bitrate_bps(const BridgeInfo& info) {
  const std::uint32_t osc_hz = info.osc_khz * 1000U;
  return bitrate_bps(compute_bit_timing(osc_hz, info.bitrate_bps), osc_hz);
}

std::optional<FirmwareVersion> firmware_of(std::span<const std::uint8_t> payload) {
  if (payload.size() < firmware_at + 3) {
    return std::nullopt;
  }
  return FirmwareVersion{payload[firmware_at], payload[firmware_at + 1], payload[firmware_at + 2]};
}

std::optional<BridgeStatus> read_status(std::span<const std::uint8_t> payload) {
  if (payload.size() != status_length - control_head ||
      payload[state_at] > static_cast<std::uint8_t>(BridgeState::stuck)) {
    return std::nullopt;
  }
  return BridgeStatus{get32(payload.data()), get32(&payload[due_at]),
                      static_cast<BridgeState>(payload[state_at]), payload[transmit_errors_at],
                      payload[receive_errors_at]};
}

CounterReports::Event CounterReports::take(std::span<const std::uint8_t> payload) {
  constexpr std::array<std::uint32_t BridgeCounters::*, counter_count> order{
      &BridgeCounters::dropped,        &BridgeCounters::overflows,   &BridgeCounters::sent,
      &BridgeCounters::not_sent,       &BridgeCounters::unknown,     &BridgeCounters::bus_offs,
      &BridgeCounters::message_errors, &BridgeCounters::chip_losses, &BridgeCounters::discarded,
      &BridgeCounters::damaged,        &BridgeCounters::overruns};
  const std::size_t count = payload.size() / 4;
  if (payload.size() != 1 + 4 * count || count < 1 || count > counters_at_once ||
      payload[0] + count > order.size()) {
    return Event::nonsense;
  }
  if (payload[0] == 0) {
    so_far_ = 0;
  }
  if (payload[0] != so_far_) {
    return Event::part;  // some before these were lost
  }
  for (std::size_t i = 0; i < count; ++i) {
    next_.*order.at(so_far_++) = get32(&payload[1 + 4 * i]);
  }
  if (so_far_ != order.size()) {
    return Event::part;
  }
  counters_ = next_;
  ++count_;
  return Event::complete;
}

}  // namespace roio::serial
