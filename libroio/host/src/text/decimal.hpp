#ifndef ROIO_DECIMAL_HPP
#define ROIO_DECIMAL_HPP

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace roio {

constexpr bool is_digit(char character) noexcept {
  return character >= '0' && character <= '9';
}

/// Whether a text is one or more decimal digits and nothing else.
constexpr bool is_digits(std::string_view text) noexcept {
  for (const char character : text) {
    if (!is_digit(character)) {
      return false;
    }
  }
  return !text.empty();
}

/// A number of decimal digits alone, without a sign and without a leading zero (which some read as
/// octal); nothing when it is another text or does not fit.
inline std::optional<std::uint32_t> read_decimal(std::string_view text) noexcept {
  if (!is_digits(text) || (text.size() > 1 && text[0] == '0')) {
    return std::nullopt;
  }
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) {
    return std::nullopt;
  }
  return value;
}

}  // namespace roio

#endif
