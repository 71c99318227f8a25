#include "robot/meaning.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "robot/alike.hpp"

namespace roio::robot_file {
namespace {

bool are_same(const Choice& a, const Choice& b) {
  return a.name == b.name && a.raw == b.raw;
}

/// All but what is for people alone: a value means the same, and is in range for both.
bool are_same(const Field& a, const Field& b) {
  return a.name == b.name && a.unit == b.unit && a.form == b.form && a.first_bit == b.first_bit &&
         a.width == b.width && a.scale.numerator == b.scale.numerator &&
         a.scale.denominator == b.scale.denominator && a.minimum == b.minimum &&
         a.maximum == b.maximum &&
         std::is_permutation(a.choices.begin(), a.choices.end(), b.choices.begin(), b.choices.end(),
                             [](const Choice& x, const Choice& y) { return are_same(x, y); });
}

bool are_same(const MessageKind& a, const MessageKind& b) {
  return a.name == b.name && a.tag == b.tag &&
         std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(),
                    [](const Field& x, const Field& y) { return are_same(x, y); });
}

/// What all who hear a broadcast call it.
struct Agreement {
  const MessageKind* message = nullptr;  ///< The first one's; null: nobody knows it.
  const Place* first = nullptr;
  const Place* other = nullptr;  ///< Who means something else.
};

/// @param key a name, or bytes.
template <typename Key>
Agreement agreement(const Robot& robot, const Place* sender, std::uint8_t subnet,
                    Key key) noexcept {
  Agreement out;
  for (const Place& place : robot.places) {
    const bool is_receiver =
        place.address.subnet == subnet && &place != sender && place.kind != nullptr;
    const MessageKind* message = is_receiver ? place.kind->hears(key) : nullptr;
    if (message != nullptr && out.message == nullptr) {
      out.message = message;
      out.first = &place;
    } else if (message != nullptr && !are_same(*message, *out.message)) {
      out.other = &place;
    }
  }
  return out;
}

template <typename Key>
Agreement look_up(const Robot& robot, const Place* sender, Address destination, Key key) noexcept {
  if (sender != nullptr && sender->kind != nullptr) {
    if (const MessageKind* said = sender->kind->says(key)) {
      return {said, sender};
    }
  }
  if (is_broadcast(destination)) {
    return agreement(robot, sender, destination.subnet, key);
  }
  const Place* receiver = robot.find(destination);
  if (receiver == nullptr || receiver->kind == nullptr) {
    return {};
  }
  return {receiver->kind->hears(key), receiver};
}

void add_names(std::vector<std::string>& names, const std::vector<MessageKind>& messages) {
  for (const MessageKind& message : messages) {
    if (std::find(names.begin(), names.end(), message.name) == names.end()) {
      names.push_back(message.name);
    }
  }
}

/// All that could have been named.
std::vector<std::string> message_names(const Robot& robot, const Place* sender,
                                       Address destination) {
  std::vector<std::string> names;
  if (sender != nullptr && sender->kind != nullptr) {
    add_names(names, sender->kind->said);
  }
  for (const Place& place : robot.places) {
    const bool is_receiver = is_broadcast(destination)
                                 ? place.address.subnet == destination.subnet && &place != sender
                                 : place.address == destination;
    if (is_receiver && place.kind != nullptr) {
      add_names(names, place.kind->heard);
    }
  }
  return names;
}

}  // namespace

Parsed<const MessageKind*> find_message(const Robot& robot, const Place* sender,
                                        Address destination, std::string_view name) {
  const Agreement found = look_up(robot, sender, destination, name);
  if (found.other != nullptr) {
    return ParseError{quote(name) + ": " + found.first->name + " and " + found.other->name +
                          " mean different things by it; expected a message to one of them",
                      0};
  }
  if (found.message == nullptr) {
    const std::string to = robot.name_of(destination);
    return ParseError{quote(name) + ": no such message to " + to + "; " +
                          advice(name, message_names(robot, sender, destination),
                                 "no kind says what " + to + " hears"),
                      0};
  }
  return found.message;
}

const MessageKind* find_meaning(const Robot& robot, const Header& header,
                                std::span<const std::uint8_t> data) noexcept {
  if (header.message_class != MessageClass::message) {
    return nullptr;
  }
  const Agreement found = look_up(robot, robot.find(header.source), header.destination, data);
  return found.other == nullptr ? found.message : nullptr;
}

}  // namespace roio::robot_file
