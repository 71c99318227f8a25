/// PlainSetup for an AVR. What is known when compiling whatever the arguments are stands in flash:
/// from RAM it would have to be put there first, which takes four bytes of program for each.
#ifndef ROIO_ARDUINO_SETUP_AVR_HPP
#define ROIO_ARDUINO_SETUP_AVR_HPP

#include <avr/pgmspace.h>

#include <roio/mcp2515.hpp>

namespace roio {

/// To Mcp2515::start() the same as a Mcp2515Config.
/// @tparam Cnf mcp2515::Cnf::word().
template <uint32_t Cnf>
class PlainSetup {
 public:
  ROIO_MCP2515_IN_LINE PlainSetup(const Mcp2515FilterPair& filters, uint8_t control)
      : filters_{mcp2515_register(filters.filter[0], 0), mcp2515_register(filters.filter[0], 1),
                 mcp2515_register(filters.filter[0], 2), mcp2515_register(filters.filter[0], 3),
                 mcp2515_register(filters.filter[1], 0), mcp2515_register(filters.filter[1], 1),
                 mcp2515_register(filters.filter[1], 2), mcp2515_register(filters.filter[1], 3)},
        control_(control) {
    constexpr uint32_t mask = mcp2515_filters_of(Address{0, 0}).mask;
    // Registers 20h..2Bh: two masks, CNF3, CNF2, CNF1, CANINTE. (GCC 5 forgets in which section the
    // static member of a template is to be.)
    __asm__(
        ".pushsection .progmem.roio,\"a\",@progbits\n"
        "1: .byte %1,%2,%3,%4, %1,%2,%3,%4, %5,%6,%7,0\n"
        ".popsection\n"
        "ldi %A0, lo8(1b)\n"
        "ldi %B0, hi8(1b)\n"
        : "=d"(rest_)
        : "i"(mcp2515_register(mask, 0)), "i"(mcp2515_register(mask, 1)),
          "i"(mcp2515_register(mask, 2)), "i"(mcp2515_register(mask, 3)),
          "i"(static_cast<uint8_t>(Cnf)), "i"(static_cast<uint8_t>(Cnf >> 8)),
          "i"(static_cast<uint8_t>(Cnf >> 16)));
  }

  uint8_t operator[](uint8_t address) const {
    return (address & 0x20U) == 0 ? filters_[address & 7U]
                                  : pgm_read_byte(rest_ + (address & 0x0FU));
  }
  uint8_t control() const { return control_; }

 private:
  uint8_t filters_[8];
  const uint8_t* rest_;
  uint8_t control_;
};

}  // namespace roio

#endif
