#include <algorithm>
#include <roio/kind.hpp>

#include "robot/alike.hpp"
#include "robot/document.hpp"
#include "robot/value_rule.hpp"

namespace roio {
namespace {

using robot_file::NotOfField;

ParseError error_at(const MessageKind& message, std::string_view field, const std::string& what) {
  return {robot_file::place_in(message.name, field) + ": " + what, 0};
}

std::vector<std::string> field_names(const MessageKind& message) {
  std::vector<std::string> names;
  for (const Field& field : message.fields) {
    names.push_back(field.name);
  }
  return names;
}

const NamedValue* find(std::span<const NamedValue> values, std::string_view name) {
  for (const NamedValue& value : values) {
    if (value.name == name) {
      return &value;
    }
  }
  return nullptr;
}

/// Names that the message does not have, or that come again.
std::optional<ParseError> check_names(const MessageKind& message,
                                      std::span<const NamedValue> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = values[i].name;
    if (message.find(name) == nullptr) {
      return error_at(message, name,
                      "no such field; " + robot_file::advice(name, field_names(message),
                                                             "expected none: it is empty"));
    }
    if (find(values.first(i), name) != nullptr) {
      return error_at(message, name, "given twice; expected once");
    }
  }
  return std::nullopt;
}

/// The lowest bits of `raw`, the highest first.
void put_bits(Bytes& bytes, const Field& field, std::int64_t raw) {
  const auto value = static_cast<std::uint64_t>(raw);
  for (unsigned i = 0; i < field.width; ++i) {
    const unsigned at = field.first_bit + i;
    const auto bit = static_cast<std::uint8_t>(value >> (field.width - 1U - i) & 1U);
    bytes.data[at / 8] = static_cast<std::uint8_t>(bytes.data[at / 8] | bit << (7U - at % 8));
  }
}

void put(Bytes& bytes, const Field& field, std::int64_t raw, const FieldValue* value) {
  if (field.form != Field::Form::bytes) {
    put_bits(bytes, field, raw);
  } else if (value != nullptr) {
    const Bytes& rest = *value->bytes();
    std::copy_n(rest.data.begin(), rest.length, bytes.data.begin() + field.first_bit / 8);
  }
}

/// What a field gets that is not named: bytes that may be none.
bool may_be_missing(const Field& field) {
  return field.form == Field::Form::bytes && field.minimum == 0;
}

}  // namespace

Parsed<Bytes> pack(const MessageKind& message, std::span<const NamedValue> values) {
  if (const auto error = check_names(message, values)) {
    return *error;
  }
  Bytes bytes;
  bytes.length = message.max_length;
  if (message.tag) {
    bytes.data[0] = *message.tag;
  }
  for (const Field& field : message.fields) {
    const NamedValue* named = find(values, field.name);
    if (named == nullptr && !may_be_missing(field)) {
      return error_at(message, field.name, "missing; expected " + robot_file::expected_of(field));
    }
    const FieldValue* value = named != nullptr ? &named->value : nullptr;
    const robot_file::RawOrNot raw =
        value != nullptr ? robot_file::raw_of(field, *value) : std::int64_t{0};
    if (const auto* why = std::get_if<NotOfField>(&raw)) {
      return error_at(message, field.name, why->message);
    }
    put(bytes, field, std::get<std::int64_t>(raw), value);
    if (field.form == Field::Form::bytes) {
      bytes.length = static_cast<std::uint8_t>(field.first_bit / 8 + std::get<std::int64_t>(raw));
    }
  }
  return bytes;
}

Parsed<Bytes> pack(const MessageKind& message, std::initializer_list<NamedValue> values) {
  return pack(message, std::span<const NamedValue>(values.begin(), values.size()));
}

Parsed<FieldValue> parse_value(const Field& field, std::string_view text) {
  if (field.form == Field::Form::bytes) {
    const Parsed<Bytes> bytes = parse_hex(text);
    if (!bytes) {
      return ParseError{field.name + ": " + bytes.error().message, bytes.error().offset};
    }
    const robot_file::RawOrNot count = robot_file::raw_of(field, *bytes);
    if (const auto* why = std::get_if<NotOfField>(&count)) {
      return ParseError{field.name + ": " + why->message, 0};
    }
    return FieldValue(*bytes);
  }
  const robot_file::RawOrNot raw = field.form == Field::Form::choice
                                       ? robot_file::raw_of(field, FieldValue(text))
                                       : robot_file::raw_of_number_text(field, text);
  if (const auto* why = std::get_if<NotOfField>(&raw)) {
    return ParseError{field.name + ": " + why->message, 0};
  }
  return robot_file::value_of(field, std::get<std::int64_t>(raw));
}

}  // namespace roio
