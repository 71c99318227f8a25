/// PlainSetup and FixedSetup for an AVR. What is known when compiling whatever the arguments are
/// stands in flash: from RAM it would have to be put there first, which takes four bytes of program
/// for each.
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
    // Registers 20h..2Ch: two masks, CNF3, CNF2, CNF1, CANINTE, CANINTF. (GCC 5 forgets in which
    // section the static member of a template is to be.)
    __asm__(
        ".pushsection .progmem.roio,\"a\",@progbits\n"
        "1: .byte %1,%2,%3,%4, %1,%2,%3,%4, %5,%6,%7,0,%8\n"
        ".popsection\n"
        "ldi %A0, lo8(1b)\n"
        "ldi %B0, hi8(1b)\n"
        : "=d"(rest_)
        : "i"(mcp2515_register(mask, 0)), "i"(mcp2515_register(mask, 1)),
          "i"(mcp2515_register(mask, 2)), "i"(mcp2515_register(mask, 3)),
          "i"(static_cast<uint8_t>(Cnf)), "i"(static_cast<uint8_t>(Cnf >> 8)),
          "i"(static_cast<uint8_t>(Cnf >> 16)), "i"(mcp2515::Interrupt::tx_any));
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

/// The same where all is known: all of it stands in flash.
/// @tparam Cnf as above. @tparam Subnet, Node whose filters these are.
template <uint32_t Cnf, uint8_t Subnet, uint8_t Node>
class FixedSetup {
 public:
  explicit FixedSetup(uint8_t control) : control_(control) {
    constexpr uint32_t mask = mcp2515_filters_of(Address{Subnet, Node}).mask;
    constexpr uint32_t first = mcp2515_filters_of(Address{Subnet, Node}).filter[0];
    constexpr uint32_t second = mcp2515_filters_of(Address{Subnet, Node}).filter[1];
    // As Mcp2515Config has it: two filters, two masks, CNF3, CNF2, CNF1, CANINTE, CANINTF.
    __asm__(
        ".pushsection .progmem.roio,\"a\",@progbits\n"
        "1: .byte %1,%2,%3,%4, %5,%6,%7,%8\n"
        "  .byte %9,%10,%11,%12, %9,%10,%11,%12, %13,%14,%15,0,%16\n"
        ".popsection\n"
        "ldi %A0, lo8(1b)\n"
        "ldi %B0, hi8(1b)\n"
        : "=d"(image_)
        : "i"(mcp2515_register(first, 0)), "i"(mcp2515_register(first, 1)),
          "i"(mcp2515_register(first, 2)), "i"(mcp2515_register(first, 3)),
          "i"(mcp2515_register(second, 0)), "i"(mcp2515_register(second, 1)),
          "i"(mcp2515_register(second, 2)), "i"(mcp2515_register(second, 3)),
          "i"(mcp2515_register(mask, 0)), "i"(mcp2515_register(mask, 1)),
          "i"(mcp2515_register(mask, 2)), "i"(mcp2515_register(mask, 3)),
          "i"(static_cast<uint8_t>(Cnf)), "i"(static_cast<uint8_t>(Cnf >> 8)),
          "i"(static_cast<uint8_t>(Cnf >> 16)), "i"(mcp2515::Interrupt::tx_any));
  }

  uint8_t operator[](uint8_t address) const {
    const uint8_t place = (address & 0x20U) == 0 ? address & 7U : address - 0x18U;
    return pgm_read_byte(image_ + place);
  }
  uint8_t control() const { return control_; }

 private:
  const uint8_t* image_;
  uint8_t control_;
};

}  // namespace roio

#endif
