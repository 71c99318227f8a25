#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <roio/robot_json.hpp>
#include <set>
#include <utility>
#include <vector>

namespace roio {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array name_fields{"from", "to", "message", "fields"};
// Where nobody is: a message that does not say who sends it.
constexpr Address nobody = broadcast_of(0);

ParseError error_in(const std::string& field, const std::string& what) {
  return {"JSON field \"" + field + "\": " + what, 0};
}

/// An object in which no field is twice; nothing for any other text.
std::optional<Json> read_object(std::string_view text) {
  std::vector<std::set<std::string>> seen;
  bool twice = false;
  Json json = Json::parse(
      text.begin(), text.end(),
      [&](int /*depth*/, Json::parse_event_t event, Json& value) {
        if (event == Json::parse_event_t::object_start) {
          seen.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
          seen.pop_back();
        } else if (event == Json::parse_event_t::key) {
          twice = !seen.back().insert(value.get<std::string>()).second || twice;
        }
        return true;
      },
      false);
  return json.is_object() && !twice ? std::optional(std::move(json)) : std::nullopt;
}

bool has_names(const Json& object) {
  for (const char* const name : name_fields) {
    if (object.contains(name)) {
      return true;
    }
  }
  return false;
}

/// Takes a text field out. @return none: it is not there.
Parsed<std::optional<std::string>> take_text(Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) {
    return std::optional<std::string>();
  }
  if (!found->is_string()) {
    return error_in(name, found->dump() + "; expected a text");
  }
  std::optional<std::string> text = found->get<std::string>();
  object.erase(found);
  return text;
}

Parsed<Address> take_address(const Robot& robot, Json& object, const char* name) {
  const auto text = take_text(object, name);
  if (!text) {
    return text.error();
  }
  if (!*text) {
    return nobody;
  }
  const auto address = robot.address_of(**text);
  return address ? address : Parsed<Address>(error_in(name, address.error().message));
}

Parsed<FieldValue> read_bytes(const std::string& name, const Json& value) {
  Bytes bytes;
  for (const Json& byte : value) {
    if (!byte.is_number_unsigned() || byte.get<std::uint64_t>() > UINT8_MAX ||
        bytes.length == bytes.data.size()) {
      return error_in(name, "expected an array of up to 8 integers 0..255");
    }
    bytes.data[bytes.length++] = byte.get<std::uint8_t>();
  }
  return FieldValue(bytes);
}

Parsed<FieldValue> read_value(const std::string& name, const Json& value) {
  if (value.is_number()) {
    return FieldValue(value.get<double>());
  }
  if (value.is_string()) {
    return FieldValue(value.get<std::string>());
  }
  if (value.is_array()) {
    return read_bytes(name, value);
  }
  return error_in(name,
                  value.dump() + "; expected a number, the name of a choice, or an array of bytes");
}

Parsed<std::vector<NamedValue>> take_values(Json& object) {
  std::vector<NamedValue> values;
  const auto found = object.find("fields");
  if (found == object.end()) {
    return values;
  }
  if (!found->is_object()) {
    return error_in("fields", "expected an object: {\"shoulder\":90}");
  }
  for (const auto& [name, json] : found->items()) {
    auto value = read_value("fields." + name, json);
    if (!value) {
      return value.error();
    }
    values.push_back({name, *value});
  }
  object.erase(found);
  return values;
}

/// Puts in what a message without names has in the place of theirs.
void put_message(Json& object, Address source, Address destination, const Bytes& bytes) {
  object["isBroadcast"] = is_broadcast(destination);
  if (!is_broadcast(destination)) {
    object["address"] = destination.node;
  }
  object["subnet"] = destination.subnet;
  object["messageLength"] = bytes.length;
  object["data"] = std::vector<int>(bytes.data.begin(), bytes.data.begin() + bytes.length);
  if (source != nobody) {
    object["source"] = to_string(source);
  }
}

/// @param object has names; without them on success.
std::optional<ParseError> resolve(const Robot& robot, Json& object) {
  const bool has_source = object.contains("from");
  const auto source = take_address(robot, object, "from");
  if (!source) {
    return source.error();
  }
  if (has_source && is_broadcast(*source)) {
    return error_in("from", "a broadcast; expected a place or SUBNET.NODE");
  }
  if (!object.contains("to")) {
    return error_in("to", "missing; expected a place or SUBNET.NODE");
  }
  const auto destination = take_address(robot, object, "to");
  if (!destination) {
    return destination.error();
  }
  const auto name = take_text(object, "message");
  if (!name || !*name) {
    return name ? error_in("message", "missing; expected the name of a message") : name.error();
  }
  const auto values = take_values(object);
  if (!values) {
    return values.error();
  }
  const auto kind = robot.message(*source, *destination, **name);
  if (!kind) {
    return error_in("message", kind.error().message);
  }
  const auto bytes = pack(**kind, *values);
  if (!bytes) {
    return error_in("fields", bytes.error().message);
  }
  put_message(object, *source, *destination, *bytes);
  return std::nullopt;
}

Json json_of(const Reading& reading) {
  if (reading.field->form == Field::Form::bytes) {
    return std::vector<int>(reading.bytes.data.begin(),
                            reading.bytes.data.begin() + reading.bytes.length);
  }
  if (reading.field->form == Field::Form::choice && reading.is_valid()) {
    return reading.text();
  }
  return Json::parse(reading.text());  // a number is written as it is read: with its own digits
}

}  // namespace

Parsed<JsonMessage> parse_json(std::string_view text, const Robot& robot) {
  auto plain = parse_json(text);
  if (plain) {
    return plain;
  }
  auto object = read_object(text);
  if (!object || !has_names(*object)) {
    return plain;
  }
  if (object->contains("data")) {
    for (const char* const name : name_fields) {
      object->erase(name);
    }
  } else if (const auto error = resolve(robot, *object)) {
    return *error;
  }
  return parse_json(object->dump());
}

std::string to_json(const JsonMessage& message, const Robot& robot) {
  std::string line = to_json(message);
  const Header& header = message.message.header;
  Json names;
  if (const Place* const from = message.has_source ? robot.find(header.source) : nullptr) {
    names["from"] = from->name;
  }
  if (const Place* const to = robot.find(header.destination)) {
    names["to"] = to->name;
  }
  if (const auto named = robot.decode(message.message)) {
    names["message"] = named->kind->name;
    Json& fields = names["fields"] = Json::object();
    for (const Reading& reading : named->readings) {
      fields[reading.field->name] = json_of(reading);
    }
  }
  if (!names.empty()) {
    line.back() = ',';
    line += names.dump().substr(1);
  }
  return line;
}

}  // namespace roio
