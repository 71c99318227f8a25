// Interrupts, error flags and pins of the simulated MCP2515 (3.4, 4.4, 6, 7).
#include <algorithm>
#include <roio/sim/mcp2515_chip.hpp>

#include "mcp2515/map.hpp"

namespace roio::sim {
namespace {

constexpr unsigned warning_limit = 96;
constexpr unsigned passive_limit = 128;

}  // namespace

// --- interrupts (7) ------------------------------------------------------------------------------

void Mcp2515Chip::set_flag(std::uint8_t flag) {
  registers_[map::canintf] |= flag;
  update_pins();
}

// The first enabled interrupt in the order of table 7-1: error, wake-up, TXB0..2, RXB0..1. A
// message error has no code.
std::uint8_t Mcp2515Chip::interrupt_code() const {
  constexpr std::array<std::uint8_t, 7> order{
      map::errif, map::wakif, map::txif(0), map::txif(1), map::txif(2), map::rxif(0), map::rxif(1)};
  const std::uint8_t pending = registers_[map::canintf] & registers_[map::caninte];
  const auto* const first = std::find_if(
      order.begin(), order.end(), [pending](std::uint8_t flag) { return (pending & flag) != 0; });
  return first == order.end() ? 0 : static_cast<std::uint8_t>(first - order.begin() + 1);
}

// --- error flags (6) -----------------------------------------------------------------------------

void Mcp2515Chip::on_confinement_changed() {
  const unsigned transmit = controller_.transmit_errors();
  const unsigned receive = controller_.receive_errors();
  const bool bus_off = controller_.confinement() == Confinement::bus_off;
  std::uint8_t bits = 0;
  bits |= bus_off ? map::txbo : 0;
  bits |= transmit >= passive_limit ? map::txep : 0;
  bits |= receive >= passive_limit ? map::rxep : 0;
  bits |= transmit >= warning_limit ? map::txwar : 0;
  bits |= receive >= warning_limit ? map::rxwar : 0;
  bits |= (bits & (map::txwar | map::rxwar)) != 0 ? map::ewarn : 0;
  const auto risen = static_cast<std::uint8_t>(bits & ~error_bits_);
  events_.bus_offs += (risen & map::txbo) != 0 ? 1 : 0;
  error_bits_ = bits;
  if (risen != 0) {
    set_flag(map::errif);
  }
}

void Mcp2515Chip::on_receive_error(BusError /*error*/) {
  set_flag(map::merrf);
}

// --- pins ----------------------------------------------------------------------------------------

bool Mcp2515Chip::interrupt_pin() const {
  return (registers_[map::canintf] & registers_[map::caninte]) == 0;
}

void Mcp2515Chip::update_pins() {
  const bool pin = interrupt_pin();
  if (pin != pin_) {
    pin_ = pin;
    if (pin_listener_) {
      pin_listener_(pin);
    }
  }
}

// BFPCTRL (register 4-3): BFS 5..4 | BFE 3..2 | BFM 1..0
std::optional<bool> Mcp2515Chip::receive_buffer_pin(int buffer) const {
  const std::uint8_t control = registers_[map::bfpctrl];
  const auto bit_is_set = [control, buffer](int lowest) {
    return ((control >> (lowest + buffer)) & 1) != 0;
  };
  if (!bit_is_set(2)) {
    return std::nullopt;
  }
  return bit_is_set(0) ? (registers_[map::canintf] & map::rxif(buffer)) == 0 : bit_is_set(4);
}

void Mcp2515Chip::set_request_to_send_pin(int buffer, bool level) {
  const auto index = static_cast<std::size_t>(buffer);
  const bool falls = rts_pins_.at(index) && !level;
  rts_pins_.at(index) = level;
  if (falls && ((registers_[map::txrtsctrl] >> buffer) & 1) != 0) {
    request_transmission(buffer);
  }
}

}  // namespace roio::sim
