// The register file of the simulated MCP2515 (11): what reading and writing it does.
#include <algorithm>
#include <array>
#include <roio/sim/mcp2515_chip.hpp>

#include "mcp2515/map.hpp"

namespace roio::sim {
namespace {

std::string hex(std::uint8_t value) {
  constexpr std::array<char, 17> digits{"0123456789ABCDEF"};
  return {digits.at(value >> 4U), digits.at(value & 0x0FU), 'h'};
}

bool is_in_transmit_buffer(std::uint8_t address) {
  return address > map::transmit_control(0) && address < map::receive_control(0) &&
         (address & 0x0F) != 0 && !map::is_canctrl(address);
}

}  // namespace

// --- reading -------------------------------------------------------------------------------------

bool Mcp2515Chip::is_readable_now(std::uint8_t address) const {
  // Filters and masks read as 0 outside configuration mode (4.5).
  return mode_ == OperationMode::configuration || !map::is_filter_or_mask(address);
}

std::uint8_t Mcp2515Chip::read_register(std::uint8_t address) const {
  return is_readable_now(address) ? peek(address) : 0;
}

std::uint8_t Mcp2515Chip::peek(std::uint8_t address) const {
  if (map::is_canstat(address)) {
    return status_register();
  }
  if (map::is_canctrl(address)) {
    return registers_[map::canctrl];
  }
  switch (address) {
    case map::tec:
      return static_cast<std::uint8_t>(std::min(controller_.transmit_errors(), 255U));
    case map::rec:
      return static_cast<std::uint8_t>(std::min(controller_.receive_errors(), 255U));
    case map::eflg:
      return static_cast<std::uint8_t>(registers_[map::eflg] | error_bits_);
    case map::bfpctrl:
      return buffer_pin_register();
    case map::txrtsctrl:
      return request_pin_register();
    default:
      return registers_.at(address);
  }
}

std::uint8_t Mcp2515Chip::status_register() const {
  return static_cast<std::uint8_t>((static_cast<int>(mode_) << map::reqop_shift) |
                                   (interrupt_code() << 1));
}

// BFS reads as 0 of a pin that shows its buffer (register 4-3).
std::uint8_t Mcp2515Chip::buffer_pin_register() const {
  const std::uint8_t value = registers_[map::bfpctrl];
  const auto shows_buffer = static_cast<std::uint8_t>(value & 3U);
  return static_cast<std::uint8_t>(value & ~(shows_buffer << 4U));
}

// The pin's level, which reads as 0 of a pin that requests (register 3-2).
std::uint8_t Mcp2515Chip::request_pin_register() const {
  unsigned value = registers_[map::txrtsctrl];
  for (unsigned pin = 0; pin < 3; ++pin) {
    const bool requests = ((value >> pin) & 1U) != 0;
    value |= (!requests && rts_pins_.at(pin) ? 8U : 0U) << pin;
  }
  return static_cast<std::uint8_t>(value);
}

// --- writing -------------------------------------------------------------------------------------

void Mcp2515Chip::modify_register(std::uint8_t address, std::uint8_t value, std::uint8_t mask) {
  if (!map::access(address).bit_modify) {
    violation("BIT MODIFY of register " + hex(address) + ", which takes no mask");
    mask = 0xFF;
  }
  write_register(address, value, mask);
}

void Mcp2515Chip::write_register(std::uint8_t address, std::uint8_t value, std::uint8_t mask) {
  const map::Access access = map::access(address);
  if (access.writable == 0) {
    return violation("write to read-only register " + hex(address));
  }
  if (access.configuration_only && mode_ != OperationMode::configuration) {
    return violation("write to register " + hex(address) + " outside configuration mode");
  }
  if (is_in_transmit_buffer(address) && (registers_.at(address & 0xF0U) & map::txreq) != 0) {
    violation("write to register " + hex(address) + " of a buffer that is pending");
  }
  std::uint8_t& target = registers_.at(map::is_canctrl(address) ? map::canctrl : address);
  const std::uint8_t before = target;
  const auto changed = static_cast<std::uint8_t>(access.writable & mask);
  target = static_cast<std::uint8_t>((before & ~changed) | (value & changed));
  register_written(address, before);
}

// What follows from a write, beyond the bits that have changed.
void Mcp2515Chip::register_written(std::uint8_t address, std::uint8_t before) {
  if (map::is_canctrl(address)) {
    return control_written();
  }
  switch (address) {
    case map::transmit_control(0):
    case map::transmit_control(1):
    case map::transmit_control(2):
      return transmit_control_written((address >> 4) - 3, before);
    case map::receive_control(0):
    case map::receive_control(1):
      return receive_control_written(address);
    case map::caninte:
    case map::canintf:
      update_pins();
      if ((registers_[map::canintf] & registers_[map::caninte] & map::wakif) != 0) {
        wake_up();
      }
      return;
    default:
      return;
  }
}

void Mcp2515Chip::control_written() {
  const std::uint8_t control = registers_[map::canctrl];
  if ((control & map::abat) != 0) {
    abort_all();
  }
  request_mode(static_cast<std::uint8_t>(control >> map::reqop_shift));
}

void Mcp2515Chip::transmit_control_written(int buffer, std::uint8_t before) {
  std::uint8_t& control = registers_.at(map::transmit_control(buffer));
  const bool requested = (control & ~before & map::txreq) != 0;
  const bool taken_back = (before & ~control & map::txreq) != 0;
  // TXREQ as it was: requesting and taking back change it themselves.
  control = static_cast<std::uint8_t>((control & ~map::txreq) | (before & map::txreq));
  if (requested) {
    request_transmission(buffer);
  } else if (taken_back) {
    take_back(buffer);
  }
}

void Mcp2515Chip::receive_control_written(std::uint8_t address) {
  std::uint8_t& control = registers_.at(address);
  if (address == map::receive_control(0)) {
    // BUKT1 is a read-only copy of BUKT (register 4-1).
    const bool rolls_over = (control & map::bukt) != 0;
    control = static_cast<std::uint8_t>((control & ~map::bukt1) | (rolls_over ? map::bukt1 : 0));
  }
  const std::uint8_t rxm = control & map::rxm;
  if (rxm != 0 && rxm != map::rxm) {
    violation("RXM 01 and 10 are reserved");
  }
}

}  // namespace roio::sim
