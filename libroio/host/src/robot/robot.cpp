#include <roio/robot.hpp>

#include <algorithm>

#include "robot/alike.hpp"
#include "robot/meaning.hpp"

namespace roio {
namespace {

// A place may well be 0.0.
constexpr Address nobody = broadcast_of(0);

std::vector<std::string> place_names(const Robot& robot) {
  std::vector<std::string> names;
  for (const Place& place : robot.places) {
    names.push_back(place.name);
  }
  return names;
}

}  // namespace

const Place* Robot::find(std::string_view place) const noexcept {
  for (const Place& one : places) {
    if (one.name == place) {
      return &one;
    }
  }
  return nullptr;
}

const Place* Robot::find(Address address) const noexcept {
  for (const Place& place : places) {
    if (place.address == address) {
      return &place;
    }
  }
  return nullptr;
}

Parsed<Address> Robot::address_of(std::string_view text) const {
  if (const Place* place = find(text)) {
    return place->address;
  }
  if (text.find('.') != std::string_view::npos) {
    return parse_address(text);
  }
  return ParseError{quote(text) + ": no such place; " +
                        robot_file::advice(text, place_names(*this), "the robot has none"),
                    0};
}

std::string Robot::name_of(Address address) const {
  const Place* place = find(address);
  return place != nullptr ? place->name : to_string(address);
}

Parsed<const MessageKind*> Robot::message(Address source, Address destination,
                                          std::string_view message_name) const {
  return robot_file::find_message(*this, find(source), destination, message_name);
}

std::optional<ParseError> Robot::objection(Address source, Address destination,
                                           const MessageKind& message, const Bytes& bytes) const {
  const MessageKind* const other =
      meaning({Priority::normal, MessageClass::message, destination, source},
              std::span(bytes.data.data(), bytes.length));
  if (other == nullptr || other->name == message.name) {
    return std::nullopt;
  }
  return ParseError{message.name + ": from " + name_of(source) + " these bytes are " + other->name,
                    0};
}

Parsed<Message> Robot::encode(std::string_view destination, std::string_view message,
                              std::span<const NamedValue> values) const {
  const Parsed<Address> to = address_of(destination);
  if (!to) {
    return to.error();
  }
  const Parsed<const MessageKind*> kind = robot_file::find_message(*this, nullptr, *to, message);
  if (!kind) {
    return kind.error();
  }
  const Parsed<Bytes> bytes = pack(**kind, values);
  if (!bytes) {
    return bytes.error();
  }
  Message out{};
  out.header = {Priority::normal, MessageClass::message, *to, nobody};
  out.length = bytes->length;
  std::copy(bytes->data.begin(), bytes->data.end(), out.data);
  return out;
}

Parsed<Message> Robot::encode(std::string_view destination, std::string_view message,
                              std::initializer_list<NamedValue> values) const {
  return encode(destination, message, std::span<const NamedValue>(values.begin(), values.size()));
}

const MessageKind* Robot::meaning(const Header& header,
                                  std::span<const std::uint8_t> data) const noexcept {
  return robot_file::find_meaning(*this, header, data);
}

std::optional<NamedMessage> Robot::decode(const Message& message) const {
  const std::span<const std::uint8_t> data(message.data,
                                           std::min<std::size_t>(message.length, max_data_length));
  const MessageKind* kind = meaning(message.header, data);
  if (kind == nullptr) {
    return std::nullopt;
  }
  return NamedMessage{kind, unpack(*kind, data)};
}

}  // namespace roio
