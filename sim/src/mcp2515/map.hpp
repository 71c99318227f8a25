// The MCP2515's registers as its datasheet lists them (section 11, table 11-1 and registers 3-1 to
// 10-2). The simulated chip's own: the driver has another list, so that a slip in one shows.
#ifndef ROIO_SIM_MCP2515_MAP_HPP
#define ROIO_SIM_MCP2515_MAP_HPP

#include <array>
#include <cstdint>

namespace roio::sim::map {

constexpr std::uint8_t register_count = 128;

constexpr std::uint8_t bfpctrl = 0x0C;
constexpr std::uint8_t txrtsctrl = 0x0D;
constexpr std::uint8_t canstat = 0x0E;  // and in every row of 16
constexpr std::uint8_t canctrl = 0x0F;  // and in every row of 16
constexpr std::uint8_t tec = 0x1C;
constexpr std::uint8_t rec = 0x1D;
constexpr std::uint8_t cnf3 = 0x28;
constexpr std::uint8_t cnf2 = 0x29;
constexpr std::uint8_t cnf1 = 0x2A;
constexpr std::uint8_t caninte = 0x2B;
constexpr std::uint8_t canintf = 0x2C;
constexpr std::uint8_t eflg = 0x2D;

// Buffers: control register, then SIDH, SIDL, EID8, EID0, DLC, D0..D7.
constexpr std::uint8_t transmit_control(int buffer) {
  return static_cast<std::uint8_t>(0x30 + 0x10 * buffer);
}
constexpr std::uint8_t receive_control(int buffer) {
  return static_cast<std::uint8_t>(0x60 + 0x10 * buffer);
}
constexpr std::uint8_t sidh = 1;
constexpr std::uint8_t sidl = 2;
constexpr std::uint8_t dlc = 5;
constexpr std::uint8_t data = 6;
constexpr std::uint8_t buffer_size = 14;

constexpr std::uint8_t filter(int index) {
  return static_cast<std::uint8_t>(index < 3 ? 0x00 + 4 * index : 0x10 + 4 * (index - 3));
}
constexpr std::uint8_t mask(int index) {
  return static_cast<std::uint8_t>(0x20 + 4 * index);
}

// TXBnCTRL (register 3-1)
constexpr std::uint8_t abtf = 0x40;
constexpr std::uint8_t mloa = 0x20;
constexpr std::uint8_t txerr = 0x10;
constexpr std::uint8_t txreq = 0x08;
constexpr std::uint8_t txp = 0x03;
// TXBnSIDL, RXFnSIDL, RXBnSIDL
constexpr std::uint8_t exide = 0x08;
constexpr std::uint8_t srr = 0x10;
constexpr std::uint8_t ide = 0x08;
// TXBnDLC, RXBnDLC
constexpr std::uint8_t rtr = 0x40;
constexpr std::uint8_t dlc_bits = 0x0F;
// RXBnCTRL (registers 4-1, 4-2)
constexpr std::uint8_t rxm = 0x60;
constexpr std::uint8_t rxrtr = 0x08;
constexpr std::uint8_t bukt = 0x04;
constexpr std::uint8_t bukt1 = 0x02;
// CANINTF, CANINTE (registers 7-1, 7-2)
constexpr std::uint8_t merrf = 0x80;
constexpr std::uint8_t wakif = 0x40;
constexpr std::uint8_t errif = 0x20;
constexpr std::uint8_t txif(int buffer) {
  return static_cast<std::uint8_t>(0x04 << buffer);
}
constexpr std::uint8_t rxif(int buffer) {
  return static_cast<std::uint8_t>(0x01 << buffer);
}
// EFLG (register 6-3)
constexpr std::uint8_t rx1ovr = 0x80;
constexpr std::uint8_t rx0ovr = 0x40;
constexpr std::uint8_t txbo = 0x20;
constexpr std::uint8_t txep = 0x10;
constexpr std::uint8_t rxep = 0x08;
constexpr std::uint8_t txwar = 0x04;
constexpr std::uint8_t rxwar = 0x02;
constexpr std::uint8_t ewarn = 0x01;
// CANCTRL (register 10-1)
constexpr std::uint8_t reqop_shift = 5;
constexpr std::uint8_t abat = 0x10;
constexpr std::uint8_t osm = 0x08;
constexpr std::uint8_t canctrl_after_reset = 0x87;
// CNF1..3 (registers 5-1 to 5-3)
constexpr std::uint8_t btlmode = 0x80;

/// What software may do to a register.
struct Access {
  std::uint8_t writable;    // bits that a write changes
  bool configuration_only;  // written in configuration mode only
  bool bit_modify;          // takes a mask; elsewhere the mask counts as FF
};

constexpr bool is_canstat(std::uint8_t address) {
  return (address & 0x0F) == canstat;
}
constexpr bool is_canctrl(std::uint8_t address) {
  return (address & 0x0F) == canctrl;
}
constexpr bool is_filter_or_mask(std::uint8_t address) {
  return address < bfpctrl || (address >= 0x10 && address < tec) ||
         (address >= 0x20 && address < cnf3);
}

constexpr bool is_mask(std::uint8_t address) {
  return is_filter_or_mask(address) && address >= mask(0);
}

constexpr Access access(std::uint8_t address) {
  const std::uint8_t column = address & 0x0F;
  if (is_canstat(address) || address == tec || address == rec) {
    return {0, false, false};
  }
  if (is_canctrl(address)) {
    return {0xFF, false, true};
  }
  if (is_filter_or_mask(address)) {
    // SIDL: SID2..0, EXIDE (filters only), EID17..16
    const bool is_sidl = column % 4 == 1;
    return {static_cast<std::uint8_t>(!is_sidl           ? 0xFF
                                      : is_mask(address) ? 0xE3
                                                         : 0xEB),
            true, false};
  }
  switch (address) {
    case bfpctrl:
      return {0x3F, false, true};
    case txrtsctrl:
      return {0x07, true, true};
    case cnf3:
      return {0xC7, true, true};
    case cnf2:
    case cnf1:
      return {0xFF, true, true};
    case caninte:
    case canintf:
      return {0xFF, false, true};
    case eflg:
      return {rx1ovr | rx0ovr, false, true};
    default:
      break;
  }
  if (address < receive_control(0)) {  // transmit buffers
    switch (column) {
      case 0:
        return {txreq | txp, false, true};
      case sidl:
        return {0xEB, false, false};
      case dlc:
        return {rtr | dlc_bits, false, false};
      default:
        return {0xFF, false, false};
    }
  }
  if (column == 0) {  // receive buffers
    return {static_cast<std::uint8_t>(address == receive_control(0) ? rxm | bukt : rxm), false,
            true};
  }
  return {0, false, false};
}

/// Filters and buffers, which the datasheet resets to "unknown".
constexpr bool has_no_reset_value(std::uint8_t address) {
  const bool in_buffer = address >= transmit_control(0) && (address & 0x0F) != 0;
  return (is_filter_or_mask(address) && !is_mask(address)) ||
         (in_buffer && !is_canstat(address) && !is_canctrl(address));
}

/// The bits that a register without reset value has at all; the others read as 0.
constexpr std::uint8_t existing(std::uint8_t address) {
  if (address < receive_control(0)) {
    return access(address).writable;
  }
  const std::uint8_t column = address & 0x0F;
  return column == sidl ? 0xFB : column == dlc ? 0x7F : 0xFF;
}

}  // namespace roio::sim::map

#endif
