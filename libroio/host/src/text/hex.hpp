#ifndef ROIO_HEX_HPP
#define ROIO_HEX_HPP

#include <cstdint>
#include <roio/text.hpp>
#include <string_view>

namespace roio {

inline constexpr char upper_hex_digits[] = "0123456789ABCDEF";

/// The value of a hexadecimal digit of either case; 16 for any other character.
constexpr std::uint8_t hex_value(char digit) noexcept {
  if (digit >= '0' && digit <= '9') {
    return static_cast<std::uint8_t>(digit - '0');
  }
  if (digit >= 'A' && digit <= 'F') {
    return static_cast<std::uint8_t>(digit - 'A' + 10);
  }
  if (digit >= 'a' && digit <= 'f') {
    return static_cast<std::uint8_t>(digit - 'a' + 10);
  }
  return 16;
}

/// parse_hex() with errors that do not quote the whole text, for texts of which it is a part.
/// @param spaces whether a space may stand where a dot may.
Parsed<Bytes> read_hex(std::string_view text, bool spaces = false);

}  // namespace roio

#endif
