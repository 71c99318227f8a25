#include <roio/text.hpp>

#include "text/decimal.hpp"
#include "text/hex.hpp"
#include "text/quote.hpp"

namespace roio {
namespace {

constexpr const char* destination_range = "expected 0..254, or * for a broadcast";
constexpr const char* source_range = "expected 0..254";

// Why a text is not a number of a range: not a number at all, one written oddly, or another one.
std::string why_not(std::string_view number) {
  if (number.empty()) {
    return " is missing";
  }
  if (!is_digits(number)) {
    return ' ' + quote(number) + " is not a number";
  }
  if (number.size() > 1 && number[0] == '0') {
    return ' ' + quote(number) + " has a leading zero";
  }
  return ' ' + (number.size() > 20 ? quote(number) : std::string(number)) + " is out of range";
}

Parsed<Address> read_address(std::string_view text, const char* node_range) {
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos) {
    return ParseError{"no dot; expected SUBNET.NODE, such as 0.2", text.size()};
  }
  const auto subnet = read_decimal(text.substr(0, dot));
  if (!subnet || *subnet > max_subnet) {
    return ParseError{"subnet" + why_not(text.substr(0, dot)) + "; expected 0..31", 0};
  }
  const std::string_view node_text = text.substr(dot + 1);
  const auto node = node_text == "*" ? broadcast_node : read_decimal(node_text);
  if (!node || *node > broadcast_node) {
    return ParseError{"node" + why_not(node_text) + "; " + node_range, dot + 1};
  }
  return Address{static_cast<std::uint8_t>(*subnet), static_cast<std::uint8_t>(*node)};
}

Parsed<Address> read_source(std::string_view text) {
  Parsed<Address> address = read_address(text, source_range);
  if (address && is_broadcast(*address)) {
    return ParseError{"a broadcast is no address of a node's own; expected node 0..254",
                      text.find('.') + 1};
  }
  return address;
}

}  // namespace

Parsed<Address> parse_address(std::string_view text) {
  return in_context("address", text, read_address(text, destination_range));
}

Parsed<Address> parse_source(std::string_view text) {
  return in_context("address", text, read_source(text));
}

std::string to_string(Address address) {
  return std::to_string(address.subnet) + '.' +
         (is_broadcast(address) ? "*" : std::to_string(address.node));
}

Parsed<Bytes> parse_hex(std::string_view text) {
  return in_context("data", text, read_hex(text, true));
}

std::string to_hex(const std::uint8_t* data, std::size_t length) {
  std::string out;
  out.reserve(2 * length);
  for (std::size_t i = 0; i < length; ++i) {
    out += upper_hex_digits[data[i] >> 4U];
    out += upper_hex_digits[data[i] & 0xFU];
  }
  return out;
}

const char* to_string(Priority priority) noexcept {
  return priority == Priority::urgent ? "urgent" : "normal";
}

const char* to_string(MessageClass message_class) noexcept {
  switch (message_class) {
    case MessageClass::message:
      return "message";
    case MessageClass::system:
      return "system";
    case MessageClass::stream:
      return "stream";
    case MessageClass::reserved:
      break;
  }
  return "reserved";
}

Parsed<Priority> parse_priority(std::string_view text) {
  for (const Priority priority : {Priority::urgent, Priority::normal}) {
    if (text == to_string(priority)) {
      return priority;
    }
  }
  return in_context("priority", text, ParseError{"expected urgent or normal", 0});
}

Parsed<BridgeMode> parse_bridge_mode(std::string_view text) {
  for (const BridgeMode mode : {BridgeMode::normal, BridgeMode::listen, BridgeMode::loopback}) {
    if (text == to_string(mode)) {
      return mode;
    }
  }
  return in_context("mode", text, ParseError{"expected normal, listen or loopback", 0});
}

Parsed<MessageClass> parse_class(std::string_view text) {
  for (const MessageClass message_class : {MessageClass::message, MessageClass::system,
                                           MessageClass::stream, MessageClass::reserved}) {
    if (text == to_string(message_class)) {
      return message_class;
    }
  }
  return in_context("class", text, ParseError{"expected message, system, stream or reserved", 0});
}

}  // namespace roio
