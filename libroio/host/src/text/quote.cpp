#include <cstddef>
#include <cstdint>
#include <roio/text.hpp>

#include "text/utf8.hpp"

namespace roio {
namespace {

constexpr std::size_t max_shown = 48;

void append_escaped(std::string& out, char character) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  const auto byte = static_cast<std::uint8_t>(character);
  out += "\\x";
  out += digits[byte >> 4U];
  out += digits[byte & 0xFU];
}

void append_ascii(std::string& out, char character) {
  switch (character) {
    case '\n':
      out += "\\n";
      return;
    case '\r':
      out += "\\r";
      return;
    case '\t':
      out += "\\t";
      return;
    case '"':
      out += "\\\"";
      return;
    case '\\':
      out += "\\\\";
      return;
    default:
      break;
  }
  if (character < ' ' || character == '\x7F') {
    append_escaped(out, character);
  } else {
    out += character;
  }
}

// U+0080..U+009F are control characters to a terminal.
bool is_c1_control(std::string_view sequence) {
  return sequence[0] == '\xC2' && static_cast<std::uint8_t>(sequence[1]) < 0xA0;
}

void append_sequence(std::string& out, std::string_view sequence) {
  if (sequence.size() == 1) {
    append_ascii(out, sequence[0]);
  } else if (is_c1_control(sequence)) {
    append_escaped(out, sequence[0]);
    append_escaped(out, sequence[1]);
  } else {
    out += sequence;
  }
}

}  // namespace

std::string quote(std::string_view text) {
  std::string out = "\"";
  std::size_t at = 0;
  while (at < text.size() && at < max_shown) {
    const std::size_t length = utf8_sequence_length(text.substr(at));
    if (length == 0) {
      append_escaped(out, text[at]);
      ++at;
    } else {
      append_sequence(out, text.substr(at, length));
      at += length;
    }
  }
  if (at == text.size()) {
    return out += '"';
  }
  return out += "...\" (" + std::to_string(text.size()) + " bytes)";
}

}  // namespace roio
