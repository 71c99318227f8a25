#include "text/utf8.hpp"

#include <array>
#include <cstdint>

namespace roio {
namespace {

// One row of RFC 3629's table: the first bytes it is for, how long the sequence is, and which
// second bytes are allowed (which is where overlong forms, surrogates and too large values show).
struct Row {
  std::uint8_t first_low;
  std::uint8_t first_high;
  std::uint8_t length;
  std::uint8_t second_low;
  std::uint8_t second_high;
};

constexpr std::array<Row, 9> rows{{{0x00, 0x7F, 1, 0x00, 0x00},
                                   {0xC2, 0xDF, 2, 0x80, 0xBF},
                                   {0xE0, 0xE0, 3, 0xA0, 0xBF},
                                   {0xE1, 0xEC, 3, 0x80, 0xBF},
                                   {0xED, 0xED, 3, 0x80, 0x9F},
                                   {0xEE, 0xEF, 3, 0x80, 0xBF},
                                   {0xF0, 0xF0, 4, 0x90, 0xBF},
                                   {0xF1, 0xF3, 4, 0x80, 0xBF},
                                   {0xF4, 0xF4, 4, 0x80, 0x8F}}};

bool follows(const Row& row, std::string_view text) {
  if (text.size() < row.length) {
    return false;
  }
  for (std::size_t i = 1; i < row.length; ++i) {
    const auto byte = static_cast<std::uint8_t>(text[i]);
    const std::uint8_t low = i == 1 ? row.second_low : 0x80;
    const std::uint8_t high = i == 1 ? row.second_high : 0xBF;
    if (byte < low || byte > high) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::size_t utf8_sequence_length(std::string_view text) noexcept {
  if (text.empty()) {
    return 0;
  }
  const auto first = static_cast<std::uint8_t>(text[0]);
  for (const Row& row : rows) {
    if (first >= row.first_low && first <= row.first_high) {
      return follows(row, text) ? row.length : 0;
    }
  }
  return 0;
}

std::size_t find_not_utf8(std::string_view text) noexcept {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = utf8_sequence_length(text.substr(at));
    if (length == 0) {
      break;
    }
    at += length;
  }
  return at;
}

}  // namespace roio
