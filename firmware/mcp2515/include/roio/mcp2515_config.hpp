/// Mcp2515Config: what Mcp2515::begin() makes of the chip.
#ifndef ROIO_MCP2515_CONFIG_HPP
#define ROIO_MCP2515_CONFIG_HPP

#include <stdint.h>

#include <roio/bit_timing.hpp>
#include <roio/filter_mcp2515.hpp>
#include <roio/mcp2515_registers.hpp>

/// What a compiler sees through only where it stands.
#define ROIO_MCP2515_IN_LINE inline __attribute__((always_inline))

namespace roio {

/// What begin() makes of the chip, in the chip's own bytes: a configuration that is known when
/// compiling costs these and no more.
class Mcp2515Config {
 public:
  /// @param one_shot each frame is tried once, then reported as failed. Needs
  ///        Traits::reports_outcomes.
  Mcp2515Config(const BitTiming& timing, const Mcp2515FilterPair& filters,
                mcp2515::Mode mode = mcp2515::Mode::normal, bool one_shot = false)
      : Mcp2515Config(mcp2515::Cnf::word(timing), filters.mask, filters.filter[0],
                      filters.filter[1], mcp2515::Control::of(mode, one_shot)) {}

  /// The same from its parts, which a compiler sees through.
  /// @param cnf Cnf::word(). @param control Control::of().
  ROIO_MCP2515_IN_LINE
  Mcp2515Config(uint32_t cnf, uint32_t mask, uint32_t first, uint32_t second, uint8_t control)
      : bytes_{mcp2515_register(first, 0),      mcp2515_register(first, 1),
               mcp2515_register(first, 2),      mcp2515_register(first, 3),
               mcp2515_register(second, 0),     mcp2515_register(second, 1),
               mcp2515_register(second, 2),     mcp2515_register(second, 3),
               mcp2515_register(mask, 0),       mcp2515_register(mask, 1),
               mcp2515_register(mask, 2),       mcp2515_register(mask, 3),
               mcp2515_register(mask, 0),       mcp2515_register(mask, 1),
               mcp2515_register(mask, 2),       mcp2515_register(mask, 3),
               static_cast<uint8_t>(cnf),       static_cast<uint8_t>(cnf >> 8),
               static_cast<uint8_t>(cnf >> 16), 0,
               mcp2515::Interrupt::tx_any},
        control_(control) {}

  bool timing_is_valid() const { return bytes_[17] != 0; }
  /// CANCTRL.
  uint8_t control() const { return control_; }
  /// Of the oscillator: 10..3200.
  uint16_t clocks_per_bit() const { return mcp2515::Cnf::clocks_per_bit(bytes_ + 16); }
  /// What the registers 00h..0Bh, 10h..1Bh and 20h..2Ch have to be: three filters, three filters,
  /// two masks and CNF3, CNF2, CNF1, CANINTE (0 at first), CANINTF (the three TXnIF). RXB1 has the
  /// filters of RXB0, so that what goes there went past RXB0 while it was full.
  uint8_t operator[](uint8_t address) const {
    return bytes_[(address & 0x20U) == 0 ? address & 7U : address - 0x18U];
  }

 private:
  uint8_t bytes_[21];
  uint8_t control_;
};

}  // namespace roio

#endif
