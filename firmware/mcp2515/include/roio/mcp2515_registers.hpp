/// The MCP2515's instructions and registers, as far as the driver needs them.
/// Source: MCP2515 datasheet DS20001801, 11 "Register Description", 12 "SPI Interface".
#ifndef ROIO_MCP2515_REGISTERS_HPP
#define ROIO_MCP2515_REGISTERS_HPP

#include <stdint.h>

#include <roio/bit_timing.hpp>

namespace roio {
namespace mcp2515 {

/// SPI instructions (table 12-1).
enum class Instruction : uint8_t {
  reset = 0xC0,
  write = 0x02,
  read = 0x03,  ///< The next one.
  bit_modify = 0x05,
  read_status = 0xA0,
  load_tx_buffer = 0x40,   ///< | load_tx()
  request_to_send = 0x80,  ///< | the buffer's bit
  read_rx_buffer = 0x90,   ///< | read_rx()
};

/// Registers (table 11-1).
enum class Register : uint8_t {
  bfpctrl = 0x0C,
  canstat = 0x0E,
  canctrl = 0x0F,
  tec = 0x1C,
  rec = 0x1D,
  caninte = 0x2B,
  canintf = 0x2C,
  eflg = 0x2D,
  txb0ctrl = 0x30,
  rxb0ctrl = 0x60,
  rxb1ctrl = 0x70,
};

/// READ RX BUFFER from SIDH on, of RXB0 or else RXB1.
constexpr uint8_t read_rx(bool first) {
  return static_cast<uint8_t>(static_cast<uint8_t>(Instruction::read_rx_buffer) |
                              (first ? 0U : 4U));
}
// A transmit buffer is named by its bit in RTS: 1, 2, 4 for buffers 0, 1, 2.

/// LOAD TX BUFFER from SIDH on: 40h, 42h, 44h.
constexpr uint8_t load_tx(uint8_t buffer) {
  return static_cast<uint8_t>(static_cast<uint8_t>(Instruction::load_tx_buffer) | (buffer & 6U));
}
constexpr uint8_t request_to_send(uint8_t buffers) {
  return static_cast<uint8_t>(static_cast<uint8_t>(Instruction::request_to_send) | buffers);
}
/// TXBnCTRL: 30h, 40h, 50h.
constexpr Register txbctrl(uint8_t buffer) {
  return static_cast<Register>(static_cast<uint8_t>(Register::txb0ctrl) + 0x10U * (buffer >> 1));
}

/// The byte that READ STATUS returns (figure 12-8):
///   7      6       5      4       3      2       1      0
///   TX2IF  TXREQ2  TX1IF  TXREQ1  TX0IF  TXREQ0  RX1IF  RX0IF
struct QuickStatus {
  static constexpr uint8_t rx0 = 0x01;
  static constexpr uint8_t rx1 = 0x02;
  static constexpr uint8_t any_rx = rx0 | rx1;
  /// From here on: all buffers are in use, but perhaps RXB0.
  static constexpr uint8_t all_in_use = 0xFE;
  static constexpr uint8_t tx0if = 0x08;
  static constexpr uint8_t txif = tx0if | 0x20 | 0x80;
  static constexpr uint8_t any_txreq = 0x04 | 0x10 | 0x40;
  /// @param buffer by its bit in RTS: 4, 10h, 40h for 1, 2, 4.
  static constexpr uint8_t txreq(uint8_t buffer) {
    return static_cast<uint8_t>(4U * buffer * buffer);
  }
};

/// CANINTE and CANINTF (registers 7-1, 7-2).
struct Interrupt {
  static constexpr uint8_t rx0 = 0x01;
  static constexpr uint8_t rx1 = 0x02;
  static constexpr uint8_t tx_any = 0x1C;
  static constexpr uint8_t error = 0x20;
  static constexpr uint8_t wake_up = 0x40;
  static constexpr uint8_t message_error = 0x80;
};

/// EFLG (register 6-3).
struct ErrorFlag {
  static constexpr uint8_t warning = 0x01;
  static constexpr uint8_t rx_passive = 0x08;
  static constexpr uint8_t tx_passive = 0x10;
  static constexpr uint8_t bus_off = 0x20;
  static constexpr uint8_t rx0_overflow = 0x40;
  static constexpr uint8_t rx1_overflow = 0x80;
  static constexpr uint8_t any_overflow = rx0_overflow | rx1_overflow;
};

/// TXBnCTRL (register 3-1).
struct TxControl {
  static constexpr uint8_t aborted = 0x40;
  static constexpr uint8_t lost_arbitration = 0x20;
  static constexpr uint8_t error = 0x10;
  /// What an ended request leaves there as it was written: no bit 7, no TXREQ, TXP.
  static constexpr uint8_t fixed = 0x8B;
};

/// RXBnCTRL (registers 4-1, 4-2). RXM is 00, by filters; 11 hands out broken frames, too, and 01
/// and 10 are reserved.
struct RxControl {
  static constexpr uint8_t by_filters = 0x00;
  static constexpr uint8_t rollover = 0x04;
  static constexpr uint8_t settings = 0x60 | rollover;
};

enum class Mode : uint8_t {
  normal = 0x00,
  asleep = 0x20,
  loopback = 0x40,
  listen_only = 0x60,
  configuration = 0x80,
};

/// Off the bus, with everything that the chip was told: until another mode.
constexpr bool is_rest(Mode mode) {
  return mode == Mode::asleep || mode == Mode::configuration;
}

/// BFPCTRL (register 4-3): RX0BF and RX1BF are driven, low while their buffer is full.
constexpr uint8_t pins_show_buffers = 0x0F;

/// CANCTRL (register 10-1) and the mode field that CANSTAT shares with it.
struct Control {
  static constexpr uint8_t mode_mask = 0xE0;
  /// Of the modes in which the chip does not rest, listen_only alone has it.
  static constexpr uint8_t only_listens = 0x20;
  static constexpr uint8_t abort_all = 0x10;
  static constexpr uint8_t one_shot = 0x08;
  /// CLKEN and CLKPRE as a reset leaves them. Not 0, so that a line stuck at 0 is noticed.
  static constexpr uint8_t clock_out = 0x07;
  /// What a reset leaves.
  static constexpr uint8_t after_reset = static_cast<uint8_t>(Mode::configuration) | clock_out;
  static constexpr uint8_t of(Mode mode, bool one_shot_too) {
    return static_cast<uint8_t>(static_cast<uint8_t>(mode) | clock_out |
                                (one_shot_too ? one_shot : uint8_t{0}));
  }
  static constexpr uint8_t with_mode(uint8_t control, Mode mode) {
    return static_cast<uint8_t>((control & ~mode_mask) | static_cast<uint8_t>(mode));
  }
  /// Of CANCTRL and CANSTAT.
  static constexpr Mode mode_of(uint8_t control) { return static_cast<Mode>(control & mode_mask); }
};

// How long a reset or another mode is waited for.
constexpr uint16_t pause_us = 200;  ///< 128 clocks (8.1) of any oscillator above 640 kHz.
constexpr uint8_t pauses = 250;     ///< 50 ms: one frame at 5 kbit/s, and 11 bits.

/// CNF1..3 (registers 5-1 to 5-3).
///   CNF1 = SJW-1 in 7..6, BRP in 5..0 | CNF2 = BTLMODE, SAM, PS1-1 in 5..3, PropSeg-1 in 2..0 |
///   CNF3 = WAKFIL, PS2-1 in 2..0
/// WAKFIL matters in sleep alone: pulses on the bus that are too short for a bit do not wake the
/// chip.
struct Cnf {
  static constexpr uint8_t cnf1(const BitTiming& t) {
    return static_cast<uint8_t>(((t.sjw - 1U) << 6) | (t.prescaler - 1U));
  }
  static constexpr uint8_t cnf2(const BitTiming& t) {
    return static_cast<uint8_t>(0x80U | (t.triple_sampling ? 0x40U : 0U) |
                                ((t.phase_seg1 - 1U) << 3) | (t.prop_seg - 1U));
  }
  static constexpr uint8_t cnf3(const BitTiming& t) {
    return static_cast<uint8_t>(0x40U | (t.phase_seg2 - 1U));
  }
  /// @param cnf CNF3, CNF2, CNF1.
  static uint16_t clocks_per_bit(const uint8_t* cnf) {
    const uint8_t quanta = static_cast<uint8_t>(1U + (cnf[1] & 7U) + 1U + ((cnf[1] >> 3) & 7U) +
                                                1U + (cnf[0] & 7U) + 1U);
    return static_cast<uint16_t>(2U * quanta * ((cnf[2] & 0x3FU) + 1U));
  }
  /// All three: 00 CNF1 CNF2 CNF3; 0 for a timing that is not valid, and never else.
  static constexpr uint32_t word(const BitTiming& t) {
    return is_valid(t) ? (static_cast<uint32_t>(cnf1(t)) << 16) |
                             (static_cast<uint32_t>(cnf2(t)) << 8) | cnf3(t)
                       : 0U;
  }
};

}  // namespace mcp2515
}  // namespace roio

#endif
