#include "send/message_words.hpp"

#include <optional>

#include "listen/bus_words.hpp"
#include "names/named_data.hpp"
#include "names/option.hpp"
#include "names/robot.hpp"
#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* empty_message = "; without DATA the message is empty";

Bytes parse_decimal(std::span<const std::string> words) {
  if (words.empty()) {
    throw UsageError(std::string("--dec: expected 1 to 8 numbers 0..255 after DEST") +
                     empty_message);
  }
  Bytes bytes;
  if (words.size() > bytes.data.size()) {
    throw UsageError("DATA: expected at most 8 bytes, found " + std::to_string(words.size()));
  }
  for (const std::string& word : words) {
    bytes.data[bytes.length++] =
        static_cast<std::uint8_t>(parse_number("DATA with --dec", word, 0, 255));
  }
  return bytes;
}

// In one word, or in several, as dump prints them.
Bytes parse_hexadecimal(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) {
    if (word.empty()) {
      throw UsageError(std::string("DATA: expected hexadecimal digits such as 5A2D00, found \"\"") +
                       empty_message);
    }
    text += (text.empty() ? "" : " ") + word;
  }
  return value_or_refuse(parse_hex(text));
}

bool is_destination(const Robot* robot, const std::string& word) {
  return word == "-" || is_frame(word) || address_of(robot, word);
}

}  // namespace

MessageWords sort_words(const Robot* robot, const MessageWords& words) {
  const bool may_be_left_out = robot != nullptr && !robot->bus.empty() && !words.bus.empty();
  if (!may_be_left_out || !is_destination(robot, words.bus)) {
    if (may_be_left_out && !looks_like_bus(words.bus) &&
        !is_destination(robot, words.destination)) {
      static_cast<void>(parse_destination(robot, words.bus));  // neither is: the first is misspelt
    }
    return words;
  }
  MessageWords sorted{bus_of(*robot), words.bus, words.data};
  if (!words.destination.empty()) {
    sorted.data.insert(sorted.data.begin(), words.destination);
  }
  return sorted;
}

bool is_frame(const std::string& destination) {
  return destination.find('#') != std::string::npos;
}

Bytes parse_data(const Robot* robot, const Header& header, std::span<const std::string> words,
                 bool decimal) {
  const bool may_have_names =
      robot != nullptr && !decimal && header.message_class == MessageClass::message;
  const auto named =
      may_have_names
          ? value_or_refuse(parse_named_data(*robot, header.source, header.destination, words))
          : std::nullopt;
  return named ? *named : parse_data_words(words, decimal);
}

Bytes parse_data_words(std::span<const std::string> words, bool decimal) {
  return decimal ? parse_decimal(words) : parse_hexadecimal(words);
}

MessageClass parse_sendable_class(const std::string& text) {
  const auto message_class = parse_class(text);
  if (!message_class || *message_class == MessageClass::reserved) {
    throw UsageError("--class: expected message, system or stream, found " + quote(text));
  }
  return *message_class;
}

}  // namespace roio::cli
