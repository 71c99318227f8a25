/// FlashSetup: what begin() makes of the chip, as it stands in the flash of an AVR: for arguments
/// that are known when compiling. From RAM it would have to be put there first, which takes four
/// bytes of program for each.
#ifndef ROIO_ARDUINO_SETUP_AVR_HPP
#define ROIO_ARDUINO_SETUP_AVR_HPP

#include <avr/pgmspace.h>

#include <roio/mcp2515.hpp>

namespace roio {

/// To Mcp2515::start() the same as a Mcp2515Config.
class FlashSetup {
 public:
  /// @param config of which the compiler knows every byte.
  ROIO_MCP2515_IN_LINE explicit FlashSetup(const Mcp2515Config& config)
      : control_(config.control()) {
    // Row for row what Mcp2515Config::operator[] says, four times 0 between rows. A constant of C++
    // cannot be made of arguments.
    __asm__(
        ".pushsection .progmem.roio,\"a\",@progbits\n"
        "1: .byte %1,%2,%3,%4, %5,%6,%7,%8, %1,%2,%3,%4, 0,0,0,0\n"
        "   .byte %1,%2,%3,%4, %5,%6,%7,%8, %1,%2,%3,%4, 0,0,0,0\n"
        "   .byte %9,%10,%11,%12, %9,%10,%11,%12, %13,%14,%15,%16\n"
        ".popsection\n"
        "ldi %A0, lo8(1b)\n"
        "ldi %B0, hi8(1b)\n"
        : "=d"(image_)
        : "i"(config[0x00]), "i"(config[0x01]), "i"(config[0x02]), "i"(config[0x03]),
          "i"(config[0x04]), "i"(config[0x05]), "i"(config[0x06]), "i"(config[0x07]),
          "i"(config[0x20]), "i"(config[0x21]), "i"(config[0x22]), "i"(config[0x23]),
          "i"(config[0x28]), "i"(config[0x29]), "i"(config[0x2A]), "i"(config[0x2B]));
  }

  uint8_t operator[](uint8_t address) const { return pgm_read_byte(image_ + address); }
  uint8_t control() const { return control_; }

 private:
  const uint8_t* image_;
  uint8_t control_;
};

}  // namespace roio

#endif
