#include <algorithm>
#include <cstddef>
#include <optional>
#include <roio/json.hpp>

#include "json/events.hpp"
#include "json/fields.hpp"
#include "text/decimal.hpp"
#include "text/json_text.hpp"
#include "text/quote.hpp"

namespace roio {
namespace {

constexpr std::size_t max_text = 4096;

std::optional<JsonField> missing_field(const JsonFields& fields) {
  for (const JsonField field : {JsonField::type, JsonField::is_broadcast, JsonField::subnet,
                                JsonField::message_length, JsonField::data}) {
    if (!fields.has(field)) {
      return field;
    }
  }
  if (!fields.has(JsonField::address) && !fields.is_broadcast) {
    return JsonField::address;
  }
  return std::nullopt;
}

// What each field allows on its own, and all of them together do not.
std::optional<std::string> contradiction(const JsonFields& fields) {
  const std::string address = std::to_string(fields.address);
  if (fields.is_broadcast && fields.address != broadcast_node) {
    return field_error(JsonField::address, address + " in a broadcast; expected 255, or none");
  }
  if (!fields.is_broadcast && fields.address == broadcast_node) {
    return unexpected(JsonField::address, address + " without isBroadcast true");
  }
  if (fields.message_length != fields.data.length) {
    return field_error(JsonField::message_length, std::to_string(fields.message_length) +
                                                      R"(, but "data" has )" +
                                                      std::to_string(fields.data.length));
  }
  const Address destination{fields.subnet, fields.address};
  if (fields.has(JsonField::destination) && fields.destination != destination) {
    return field_error(JsonField::destination, quote(to_string(fields.destination)) +
                                                   R"(, but "subnet" and "address" say )" +
                                                   quote(to_string(destination)));
  }
  return std::nullopt;
}

JsonMessage make_message(const JsonFields& fields) {
  JsonMessage out;
  out.message.header = {fields.priority, fields.message_class,
                        Address{fields.subnet, fields.address}, fields.source};
  out.message.length = fields.data.length;
  std::copy(fields.data.data.begin(), fields.data.data.end(), out.message.data);
  out.has_source = fields.has(JsonField::source);
  out.time = fields.timestamp;
  return out;
}

bool is_of_a_word(char character) {
  return is_digit(character) || (character >= 'a' && character <= 'z') ||
         (character >= 'A' && character <= 'Z') || character == '-' || character == '.';
}

/// Where what is in the way begins. The parser stops within a word that is none: at "ailing" of
/// "trailing", which begins as true does; and behind a whole message it reads on to the next fault.
std::size_t start_of_fault(std::string_view text, std::size_t fault) {
  bool in_text = false;
  std::size_t depth = 0;
  for (std::size_t at = 0; at < fault; ++at) {
    if (in_text && text[at] == '\\') {
      ++at;
    } else if (text[at] == '"') {
      in_text = !in_text;
    } else if (!in_text && text[at] == '{') {
      ++depth;
    } else if (!in_text && text[at] == '}' && --depth == 0) {
      return text.find_first_not_of(" \t\r\n", at + 1);
    }
  }
  while (!in_text && fault > 0 && is_of_a_word(text[fault - 1])) {
    --fault;
  }
  return fault;
}

ParseError not_json(std::string_view text, const JsonEvents& events) {
  std::size_t offset = events.syntax_error().value_or(0);
  const std::string field =
      events.last_field() ? std::string(R"(, in or after field ")") + events.last_field() + '"'
                          : "";
  if (offset >= text.size() && !events.is_complete()) {
    return {"JSON: ends too early, after " + std::to_string(text.size()) + " bytes" + field,
            text.size()};
  }
  offset = start_of_fault(text, offset);
  const std::string there = quote(text.substr(offset));
  if (events.is_complete()) {
    return {"JSON: " + there + " after the message; expected nothing more", offset};
  }
  return {"JSON: not valid at byte " + std::to_string(offset) + field + ": " + there, offset};
}

}  // namespace

Parsed<JsonMessage> parse_json(std::string_view text) {
  if (const auto error = check_json_text(text, max_text)) {
    return *error;
  }
  JsonEvents events;
  const bool is_read = nlohmann::json::sax_parse(text, &events);
  if (events.error()) {
    return *events.error();
  }
  if (!is_read) {
    return not_json(text, events);
  }
  const JsonFields& fields = events.fields();
  if (const auto missing = missing_field(fields)) {
    return ParseError{unexpected(*missing, "missing"), text.size()};
  }
  if (const auto error = contradiction(fields)) {
    return ParseError{*error, 0};
  }
  return make_message(fields);
}

}  // namespace roio
