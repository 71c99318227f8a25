#include "text/hex.hpp"

#include <cstddef>
#include <string>

#include "text/quote.hpp"

namespace roio {
namespace {

bool is_between(char character, bool spaces) {
  return character == '.' || (spaces && character == ' ');
}

ParseError bad_pair(std::string_view text, std::size_t at, bool spaces) {
  if (text[at] == '.') {
    return {"a dot where a byte was expected; dots stand between bytes", at};
  }
  if (hex_value(text[at]) > 15) {
    return {quote(text.substr(at, 1)) + " is no hex digit", at};
  }
  if (at + 1 < text.size() && !is_between(text[at + 1], spaces) && hex_value(text[at + 1]) > 15) {
    return {quote(text.substr(at + 1, 1)) + " is no hex digit", at + 1};
  }
  return {"odd number of hex digits; expected two per byte", at};
}

bool is_pair(std::string_view text, std::size_t at) {
  return at + 1 < text.size() && hex_value(text[at]) <= 15 && hex_value(text[at + 1]) <= 15;
}

}  // namespace

Parsed<Bytes> read_hex(std::string_view text, bool spaces) {
  Bytes bytes;
  std::size_t count = 0;
  std::size_t at = 0;
  std::size_t ninth = 0;
  while (at < text.size()) {
    if (count > 0 && is_between(text[at], spaces)) {
      ++at;
      if (at == text.size()) {
        return ParseError{text[at - 1] == '.'
                              ? "a dot after the last byte; dots stand between bytes"
                              : "a space after the last byte; spaces stand between bytes",
                          at - 1};
      }
    }
    if (!is_pair(text, at)) {
      return bad_pair(text, at, spaces);
    }
    if (count < bytes.data.size()) {
      bytes.data[count] =
          static_cast<std::uint8_t>((hex_value(text[at]) << 4U) | hex_value(text[at + 1]));
    } else if (count == bytes.data.size()) {
      ninth = at;
    }
    ++count;
    at += 2;
  }
  if (count > bytes.data.size()) {
    return ParseError{std::to_string(count) + " bytes; a frame carries at most 8", ninth};
  }
  bytes.length = static_cast<std::uint8_t>(count);
  return bytes;
}

}  // namespace roio
