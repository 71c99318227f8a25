#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <roio/robot_json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "text/json_text.hpp"

namespace roio {
namespace {

using Json = nlohmann::ordered_json;

// What a message without names has in the place of theirs.
constexpr std::array name_fields{"from", "to", "message", "fields"};
constexpr std::array byte_fields{"isBroadcast",   "address", "subnet",
                                 "messageLength", "source",  "destination"};
// Where nobody is: a message that does not say who sends it.
constexpr Address nobody = broadcast_of(0);
// Texts of names are longer than bytes. It bounds looking fields up, too, one after the other.
constexpr std::size_t max_text = 16384;
// fields.data[0]
constexpr int max_depth = 2;

ParseError error_in(const std::string& field, const std::string& what) {
  return {"JSON field " + quote(field) + ": " + what, 0};
}

/// A value in an error: short, on one line.
std::string shown(const Json& value) {
  if (value.is_string()) {
    return quote(value.get<std::string>());
  }
  if (value.is_structured()) {
    return value.is_object() ? "an object" : "an array";
  }
  return value.dump();
}

bool is_name_field(std::string_view name) {
  return std::find(name_fields.begin(), name_fields.end(), name) != name_fields.end();
}

/// Reads a text whole, and sees what the parser itself does not mind.
class ObjectReader {
 public:
  /// @return an error, too, where a field is twice, or something is nested too deep.
  Parsed<Json> read(std::string_view text) {
    try {
      Json json = Json::parse(text.begin(), text.end(),
                              [this](int depth, Json::parse_event_t event, Json& value) {
                                return take(depth, event, value);
                              });
      return fault_ ? Parsed<Json>(*fault_) : Parsed<Json>(std::move(json));
    } catch (const Json::parse_error& error) {
      return fault_ ? *fault_ : not_json(text, error.byte);
    } catch (const Json::exception&) {  // a number above all that a double holds
      return fault_ ? *fault_ : ParseError{"JSON: a number out of range", 0};
    }
  }

  /// Whether one of the name fields came, up to where the reading ended.
  [[nodiscard]] bool has_names() const { return has_names_; }

 private:
  static ParseError not_json(std::string_view text, std::size_t bytes_read) {
    const std::size_t offset = bytes_read > 0 ? bytes_read - 1 : 0;
    if (offset >= text.size()) {
      return {"JSON: ends too early, after " + std::to_string(text.size()) + " bytes", text.size()};
    }
    return {"JSON: not valid at byte " + std::to_string(offset) + ": " + quote(text.substr(offset)),
            offset};
  }

  /// @return false: nothing is built. Of what is behind a fault, so that its depth costs nothing.
  bool take(int depth, Json::parse_event_t event, const Json& value) {
    using Event = Json::parse_event_t;
    if (fault_) {
      return false;
    }
    if ((event == Event::object_start || event == Event::array_start) && depth > max_depth) {
      fault_ = ParseError{"JSON: nested deeper than a message ever is", 0};
    } else if (event == Event::object_start) {
      seen_.emplace_back();
    } else if (event == Event::object_end) {
      seen_.pop_back();
    } else if (event == Event::key) {
      take_key(depth, value.get<std::string>());
    }
    return !fault_;
  }

  void take_key(int depth, const std::string& name) {
    has_names_ = has_names_ || (depth == 1 && is_name_field(name));
    if (!seen_.back().insert(name).second) {
      fault_ = error_in((depth == 1 ? "" : "fields.") + name, "given twice; expected once");
    }
  }

  std::vector<std::set<std::string>> seen_;
  std::optional<ParseError> fault_;
  bool has_names_ = false;
};

/// Takes a text field out. @return none: it is not there.
Parsed<std::optional<std::string>> take_text(Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) {
    return std::optional<std::string>();
  }
  if (!found->is_string()) {
    return error_in(name, shown(*found) + "; expected a text");
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
                  shown(value) + "; expected a number, the name of a choice, or an array of bytes");
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
void put_message(Json& object, const std::optional<Address>& source, Address destination,
                 const Bytes& bytes) {
  object["isBroadcast"] = is_broadcast(destination);
  if (!is_broadcast(destination)) {
    object["address"] = destination.node;
  }
  object["subnet"] = destination.subnet;
  object["messageLength"] = bytes.length;
  object["data"] = std::vector<int>(bytes.data.begin(), bytes.data.begin() + bytes.length);
  if (source) {
    object["source"] = to_string(*source);
  }
}

/// What cannot be beside names: it says the same, or something else.
std::optional<ParseError> contradiction(const Json& object) {
  for (const char* const name : byte_fields) {
    if (object.contains(name)) {
      return error_in(name, R"(expected none beside "to")");
    }
  }
  const auto message_class = object.find("class");
  if (message_class != object.end() && *message_class != "message") {
    return error_in("class",
                    shown(*message_class) + R"(; expected "message", as that alone has names)");
  }
  return std::nullopt;
}

/// Whose names hold: of "from", else of `default_source`.
Parsed<Address> take_source(const Robot& robot, Json& object, Address default_source) {
  if (!object.contains("from")) {
    return default_source;
  }
  const auto source = take_address(robot, object, "from");
  return source && is_broadcast(*source)
             ? error_in("from", "a broadcast; expected a place or SUBNET.NODE")
             : source;
}

Parsed<Bytes> take_bytes(const Robot& robot, Json& object, Address source, Address destination) {
  const auto name = take_text(object, "message");
  if (!name || !*name) {
    return name ? error_in("message", "missing; expected the name of a message") : name.error();
  }
  const auto values = take_values(object);
  if (!values) {
    return values.error();
  }
  const auto kind = robot.message(source, destination, **name);
  if (!kind) {
    return error_in("message", kind.error().message);
  }
  auto bytes = pack(**kind, *values);
  if (!bytes) {
    return error_in("fields", bytes.error().message);
  }
  if (const auto other = robot.objection(source, destination, **kind, *bytes)) {
    return error_in("message", other->message);
  }
  return bytes;
}

/// @param object has names; without them on success.
std::optional<ParseError> resolve(const Robot& robot, Json& object, Address default_source) {
  if (auto error = contradiction(object)) {
    return error;
  }
  const bool has_source = object.contains("from");
  const auto source = take_source(robot, object, default_source);
  if (!source) {
    return source.error();
  }
  if (!object.contains("to")) {
    return error_in("to", "missing; expected a place or SUBNET.NODE");
  }
  const auto destination = take_address(robot, object, "to");
  if (!destination) {
    return destination.error();
  }
  const auto bytes = take_bytes(robot, object, *source, *destination);
  if (!bytes) {
    return bytes.error();
  }
  put_message(object, has_source ? std::optional(*source) : std::nullopt, *destination, *bytes);
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

Parsed<JsonMessage> parse_json(std::string_view text, const Robot& robot, Address default_source) {
  auto plain = parse_json(text);
  if (plain) {
    return plain;
  }
  if (auto error = check_json_text(text, max_text)) {
    return *error;
  }
  ObjectReader reader;
  const auto read = reader.read(text);
  if (!reader.has_names()) {
    return plain;
  }
  if (!read) {
    return read.error();
  }
  Json object = *read;
  if (object.contains("data")) {
    for (const char* const name : name_fields) {
      object.erase(name);
    }
  } else if (const auto error = resolve(robot, object, default_source)) {
    return *error;
  }
  return parse_json(object.dump());
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
  Message known = message.message;
  if (!message.has_source) {
    known.header.source = nobody;
  }
  if (const auto named = robot.decode(known)) {
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
