// One frame as can-utils write it: ID#DATA, ID#R and ID#Rn.
// Source: can-utils 2020.11 lib.c, parse_canframe() and sprint_canframe(); the length code of 2021.
#include "text/frame_text.hpp"

#include <algorithm>
#include <array>
#include <roio/candump_log.hpp>

#include "text/decimal.hpp"
#include "text/hex.hpp"
#include "text/quote.hpp"

namespace roio {
namespace {

constexpr std::size_t standard_digits = 3;
constexpr std::size_t extended_digits = 8;

struct Identifier {
  FrameKind kind;
  std::uint32_t id;
};

ParseError id_out_of_range(std::string_view digits) {
  return {"identifier " + std::string(digits) + " is out of range; expected " +
              (digits.size() == standard_digits
                   ? "000..7FF"
                   : "00000000..1FFFFFFF, or 20000000..3FFFFFFF for an error report"),
          0};
}

Parsed<Identifier> classify(std::string_view digits, std::uint32_t value) {
  constexpr std::uint32_t error_bit = tagged_id(FrameKind::error, 0);
  if (digits.size() == standard_digits) {
    if (value > max_id(FrameKind::standard)) {
      return id_out_of_range(digits);
    }
    return Identifier{FrameKind::standard, value};
  }
  if (value <= max_id(FrameKind::extended)) {
    return Identifier{FrameKind::extended, value};
  }
  if (value - error_bit <= max_id(FrameKind::error)) {
    return Identifier{FrameKind::error, value - error_bit};
  }
  return id_out_of_range(digits);
}

Parsed<Identifier> read_identifier(std::string_view digits) {
  if (digits.size() != standard_digits && digits.size() != extended_digits) {
    return ParseError{"an identifier of " + std::to_string(digits.size()) +
                          " digits; expected 3 (standard) or 8 (extended)",
                      0};
  }
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const std::uint8_t digit = hex_value(digits[i]);
    if (digit > 15) {
      return ParseError{quote(digits.substr(i, 1)) + " is no hex digit of an identifier", i};
    }
    value = (value << 4U) | digit;
  }
  return classify(digits, value);
}

// CAN XL as later can-utils print it: priority and network in 5 digits, then FLAGS:TYPE:FIELD#.
bool looks_like_can_xl(std::string_view text, std::size_t hash) {
  return hash == 5 && text.size() > 11 && text[8] == ':' && text[11] == ':';
}

std::optional<ParseError> other_format(std::string_view text, std::size_t hash) {
  if (hash == std::string_view::npos) {
    return ParseError{"no '#'; expected ID#DATA, such as 1004A00A#5A2D00", text.size()};
  }
  if (hash + 1 < text.size() && text[hash + 1] == '#') {
    return ParseError{"a CAN FD frame (\"##\"); only classic CAN frames are taken", hash};
  }
  if (looks_like_can_xl(text, hash)) {
    return ParseError{"a CAN XL frame; only classic CAN frames are taken", hash};
  }
  return std::nullopt;
}

Parsed<Frame> make_remote(Identifier identifier, std::string_view length, std::size_t offset) {
  if (identifier.kind == FrameKind::error) {
    return ParseError{"an error report is never a remote request", offset - 1};
  }
  if (length.size() > 1 || (!length.empty() && !is_digit(length[0]))) {
    return ParseError{quote(length) + " after R; expected the length asked for, 0..8, or nothing",
                      offset};
  }
  const std::size_t asked_for = length.empty() ? 0 : hex_value(length[0]);
  if (asked_for > max_data_length) {
    return ParseError{"a remote request for 9 bytes; a frame carries at most 8", offset};
  }
  return Frame{identifier.id,
               identifier.kind == FrameKind::extended ? FrameKind::extended_remote
                                                      : FrameKind::standard_remote,
               static_cast<std::uint8_t>(asked_for),
               {}};
}

/// "_9" to "_F" at the end, which tells the length code of a frame of 8 bytes
/// (CAN_CTRLMODE_CC_LEN8_DLC).
std::size_t length_code_size(std::string_view text) {
  const bool there = text.size() >= 2 && text[text.size() - 2] == '_' &&
                     hex_value(text.back()) > max_data_length && hex_value(text.back()) <= 15;
  return there ? 2 : 0;
}

// cansend also takes one dot before the first byte and one after the last.
std::size_t strip_outer_dots(std::string_view& data) {
  const std::size_t leading = data.starts_with('.') ? 1 : 0;
  data.remove_prefix(leading);
  if (data.size() > 1 && data.ends_with('.')) {
    data.remove_suffix(1);
  }
  return leading;
}

Parsed<Frame> make_data(Identifier identifier, std::string_view data, std::size_t offset) {
  const std::size_t dots = strip_outer_dots(data);
  const Parsed<Bytes> bytes = read_hex(data);
  if (!bytes) {
    return ParseError{bytes.error().message, offset + dots + bytes.error().offset};
  }
  Frame frame{identifier.id, identifier.kind, bytes->length, {}};
  std::copy(bytes->data.begin(), bytes->data.end(), frame.data);
  return frame;
}

char* write_hex_byte(char* out, std::uint8_t byte) noexcept {
  out[0] = upper_hex_digits[byte >> 4U];
  out[1] = upper_hex_digits[byte & 0xFU];
  return out + 2;
}

char* write_identifier(char* out, const Frame& frame) noexcept {
  if (frame.kind == FrameKind::standard || frame.kind == FrameKind::standard_remote) {
    out[0] = upper_hex_digits[(frame.id >> 8U) & 0x7U];
    return write_hex_byte(out + 1, static_cast<std::uint8_t>(frame.id));
  }
  // Of the tag, the log shows bit 29 alone: eight digits say that a frame is extended.
  const std::uint32_t shown = (frame.id & max_id(FrameKind::extended)) |
                              (frame.kind == FrameKind::error ? tagged_id(frame.kind, 0) : 0U);
  for (std::uint32_t shift = 32; shift > 0; shift -= 8) {
    out = write_hex_byte(out, static_cast<std::uint8_t>(shown >> (shift - 8)));
  }
  return out;
}

}  // namespace

Parsed<Frame> read_frame(std::string_view text) {
  const std::size_t hash = text.find('#');
  if (const auto error = other_format(text, hash)) {
    return *error;
  }
  const Parsed<Identifier> identifier = read_identifier(text.substr(0, hash));
  if (!identifier) {
    return identifier.error();
  }
  std::string_view rest = text.substr(hash + 1);
  const std::size_t code_size = length_code_size(rest);
  rest.remove_suffix(code_size);
  const Parsed<Frame> frame = rest.starts_with('R') || rest.starts_with('r')
                                  ? make_remote(*identifier, rest.substr(1), hash + 2)
                                  : make_data(*identifier, rest, hash + 1);
  if (frame && code_size > 0 && frame->length != max_data_length) {
    return ParseError{"length code " + quote(text.substr(text.size() - code_size)) + " with " +
                          std::to_string(frame->length) + " bytes; expected it with 8 only",
                      text.size() - code_size};
  }
  return frame;
}

char* write_frame(char* out, const Frame& frame) noexcept {
  out = write_identifier(out, frame);
  *out++ = '#';
  const std::uint8_t length = std::min(frame.length, max_data_length);
  if (is_remote(frame.kind)) {
    *out++ = 'R';
    if (length > 0) {
      *out++ = static_cast<char>('0' + length);
    }
    return out;
  }
  for (std::uint8_t i = 0; i < length; ++i) {
    out = write_hex_byte(out, frame.data[i]);
  }
  return out;
}

Parsed<Frame> parse_frame_text(std::string_view text) {
  return in_context("frame", text, read_frame(text));
}

std::string to_text(const Frame& frame) {
  std::array<char, max_frame_text> buffer{};
  return {buffer.data(), write_frame(buffer.data(), frame)};
}

}  // namespace roio
