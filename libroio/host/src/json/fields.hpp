#ifndef ROIO_JSON_FIELDS_HPP
#define ROIO_JSON_FIELDS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <roio/text.hpp>
#include <string>

namespace roio {

/// The fields of a Roio message in JSON. Source: docs/protocol.md "JSON".
enum class JsonField : std::uint8_t {
  type,
  is_broadcast,
  address,
  subnet,
  message_length,
  data,
  priority,
  message_class,
  source,
  destination,
  timestamp,
};

struct FieldRule {
  JsonField field;
  const char* name;
  const char* expected;
};

inline constexpr std::array<FieldRule, 11> field_rules{
    {{JsonField::type, "type", R"("Roio")"},
     {JsonField::is_broadcast, "isBroadcast", "true or false"},
     {JsonField::address, "address", "an integer 0..254"},
     {JsonField::subnet, "subnet", "an integer 0..31"},
     {JsonField::message_length, "messageLength", "an integer 0..8"},
     {JsonField::data, "data", "an array of up to 8 integers 0..255"},
     {JsonField::priority, "priority", R"("urgent" or "normal")"},
     {JsonField::message_class, "class", R"("message", "system" or "stream")"},
     {JsonField::source, "source", R"("SUBNET.NODE", such as "0.10")"},
     {JsonField::destination, "destination", R"("SUBNET.NODE" or "SUBNET.*")"},
     {JsonField::timestamp, "timestamp", "seconds since 1970, a number 0..9223372036.854775807"}}};

inline const FieldRule& rule_of(JsonField field) {
  return field_rules[static_cast<std::size_t>(field)];
}

/// JSON field "address": 256
inline std::string field_error(JsonField field, const std::string& what) {
  return std::string("JSON field \"") + rule_of(field).name + "\": " + what;
}

/// JSON field "address": 256; expected an integer 0..254
inline std::string unexpected(JsonField field, const std::string& value) {
  return field_error(field, value + "; expected " + rule_of(field).expected);
}

/// What the fields said, before it is known whether they agree.
struct JsonFields {
  std::array<bool, field_rules.size()> seen{};
  bool is_broadcast = false;
  std::uint8_t address = broadcast_node;
  std::uint8_t subnet = 0;
  std::uint8_t message_length = 0;
  Bytes data;
  Priority priority = Priority::normal;
  MessageClass message_class = MessageClass::message;
  Address source{};
  Address destination{};
  std::optional<Timestamp> timestamp;

  [[nodiscard]] bool has(JsonField field) const { return seen[static_cast<std::size_t>(field)]; }
};

}  // namespace roio

#endif
