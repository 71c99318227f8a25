/// The bytes of a numbered message, as `roio-cli gen` sends and `roio-cli gen --check` reads them.
///
///   byte 0      generator: bits 6..0 which of several on one bus, bit 7 its source varies
///   byte 1      check: of all the others and the length, CRC-8
///   byte 2..    number: as many of its low bytes as there is room for, 4 at most, high byte first
///   the rest    filler: from number and generator, so that frames differ in length on the wire
///
/// 4 bytes carry 16 bits of the number, 6 and more all 32; whoever reads them knows the others from
/// the number before. What no generator made passes for numbered once in 256 with 4 bytes, once in
/// 16 million with 8.
#ifndef ROIO_CLI_NUMBERED_HPP
#define ROIO_CLI_NUMBERED_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <roio/frame.hpp>
#include <span>

namespace roio::cli {

inline constexpr std::uint8_t shortest_numbered = 4;

inline constexpr std::uint8_t max_generator = 127;

struct Generator {
  std::uint8_t id = 0;  ///< 0..127.
  bool roams = false;   ///< Its messages have any source: the id alone says whose they are.
};

struct Numbered {
  Generator generator;
  std::uint32_t number = 0;  ///< Its low `bits` bits.
  std::uint8_t bits = 32;    ///< 16, 24 or 32: how many of the number the message has.
};

/// @param length 4..8.
std::array<std::uint8_t, max_data_length> write_numbered(Generator generator, std::uint32_t number,
                                                         std::uint8_t length);
/// None: no numbered message, or a damaged one.
std::optional<Numbered> read_numbered(std::span<const std::uint8_t> data);

}  // namespace roio::cli

#endif
