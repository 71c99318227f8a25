/// What an ELF file for an AVR holds: the bytes of the flash, and which MCU it was made for.
#ifndef ROIO_SIM_AVR_IMAGE_HPP
#define ROIO_SIM_AVR_IMAGE_HPP

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace roio::sim {

struct AvrImage {
  std::vector<std::uint8_t> flash;   // from address 0
  std::vector<std::uint8_t> eeprom;  // from address 0
  std::string mcu;                   // as avr-libc notes it; empty: not noted
  unsigned architecture = 0;         // of avr-gcc: 5 up to 128 KiB, 6 above
};

/// @throws std::runtime_error with the file's name and what is wrong with it.
AvrImage read_avr_image(const std::filesystem::path& path);

}  // namespace roio::sim

#endif
