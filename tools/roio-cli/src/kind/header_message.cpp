#include "kind/header_message.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace roio::cli::header {
namespace {

constexpr unsigned byte_bits = 8;

bool is_bytes(const Field& field) {
  return field.form == Field::Form::bytes;
}

unsigned first_byte(const Field& field) {
  return field.first_bit / byte_bits;
}
/// How far to the left its lowest bit stands in its byte.
unsigned shift_of(const Field& field) {
  return byte_bits - field.first_bit % byte_bits - field.width;
}
bool is_part_of_a_byte(const Field& field) {
  return !is_bytes(field) && field.width < byte_bits;
}

unsigned type_bits(const Field& field) {
  if (field.width <= 8) {
    return 8;
  }
  return field.width <= 16 ? 16 : 32;
}

/// All numbers from the smallest to the largest choice are choices.
bool has_no_gap(const std::vector<Choice>& choices) {
  const auto [smallest, largest] =
      std::minmax_element(choices.begin(), choices.end(),
                          [](const Choice& a, const Choice& b) { return a.raw < b.raw; });
  return static_cast<std::size_t>(largest->raw - smallest->raw) + 1 == choices.size();
}

// --- pack
// -------------------------------------------------------------------------------------------

/// The bytes of a number, the highest first: bytes[1] = ..., one line each.
std::string pack_number(const FieldNames& names) {
  const Field& field = *names.field;
  const std::string value = "from." + names.member;
  const unsigned count = field.width / byte_bits;
  if (count == 1 && field.form == Field::Form::number) {
    return fmt::format("  bytes[{}] = {};\n", first_byte(field), value);
  }
  const std::string raw = count > 1 && field.form == Field::Form::signed_number
                              ? fmt::format("static_cast<uint{}_t>({})", type_bits(field), value)
                              : value;
  std::string text;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned shift = (count - 1 - i) * byte_bits;
    text += fmt::format("  bytes[{}] = static_cast<uint8_t>({}{});\n", first_byte(field) + i, raw,
                        shift == 0 ? "" : fmt::format(" >> {}", shift));
  }
  return text;
}

/// One byte that `parts` share.
std::string pack_parts(const std::vector<const FieldNames*>& parts) {
  std::string sum;
  for (const FieldNames* part : parts) {
    const unsigned shift = shift_of(*part->field);
    const std::string value = part->choice_type.empty()
                                  ? "from." + part->member
                                  : fmt::format("static_cast<uint8_t>(from.{})", part->member);
    sum += sum.empty() ? "" : " | ";
    sum += shift == 0 ? value : fmt::format("({} << {})", value, shift);
  }
  return fmt::format("  bytes[{}] = static_cast<uint8_t>({});\n", first_byte(*parts.front()->field),
                     sum);
}

std::string pack_bytes(const FieldNames& names) {
  const std::string count = names.count_member.empty() ? literal(names.field->maximum, false)
                                                       : "from." + names.count_member;
  const unsigned first = first_byte(*names.field);
  return fmt::format("  for (uint8_t i = 0; i < {}; ++i) {{\n    bytes[{}i] = from.{}[i];\n  }}\n",
                     count, first == 0 ? "" : fmt::format("{} + ", first), names.member);
}

std::string pack_fields(const MessageNames& names) {
  std::string text;
  std::vector<const FieldNames*> parts;
  const auto finish_byte = [&] {
    text += parts.empty() ? "" : pack_parts(parts);
    parts.clear();
  };
  for (const FieldNames& field : names.fields) {
    if (!parts.empty() && (!is_part_of_a_byte(*field.field) ||
                           first_byte(*field.field) != first_byte(*parts.front()->field))) {
      finish_byte();
    }
    if (is_part_of_a_byte(*field.field)) {
      parts.push_back(&field);
    } else if (!is_bytes(*field.field)) {
      text += pack_number(field);
    } else {
      text += pack_bytes(field);
    }
  }
  finish_byte();
  return text;
}

// --- unpack
// -----------------------------------------------------------------------------------------

/// The unsigned number that stands on the wire.
std::string read_unsigned(const Field& field) {
  const unsigned first = first_byte(field);
  if (field.width < byte_bits) {
    const unsigned shift = shift_of(field);
    const std::string byte = shift == 0 ? fmt::format("bytes[{}]", first)
                                        : fmt::format("(bytes[{}] >> {})", first, shift);
    return fmt::format("static_cast<uint8_t>({} & {})", byte, (1U << field.width) - 1);
  }
  if (field.width == byte_bits) {
    return fmt::format("bytes[{}]", first);
  }
  const unsigned count = field.width / byte_bits;
  const std::string type = fmt::format("uint{}_t", type_bits(field));
  std::string sum;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned shift = (count - 1 - i) * byte_bits;
    sum += i == 0 ? "" : " | ";
    sum += shift == 0 ? fmt::format("bytes[{}]", first + i)
                      : fmt::format("(static_cast<{}>(bytes[{}]) << {})", type, first + i, shift);
  }
  return type_bits(field) == 16 ? fmt::format("static_cast<{}>({})", type, sum) : sum;
}

std::string read_field(const FieldNames& names) {
  const Field& field = *names.field;
  const std::string raw = read_unsigned(field);
  if (!names.choice_type.empty()) {
    return fmt::format("static_cast<{}>({})", names.choice_type, raw);
  }
  if (field.form != Field::Form::signed_number) {
    return raw;
  }
  if (field.width == 24) {  // the sign, from bit 23 up to bit 31
    return fmt::format("static_cast<int32_t>(({}) ^ 0x800000UL) - 0x800000L", raw);
  }
  return fmt::format("static_cast<int{}_t>({})", field.width, raw);
}

std::string unpack_bytes(const FieldNames& bytes) {
  const unsigned first = first_byte(*bytes.field);
  std::string text;
  std::string count = literal(bytes.field->maximum, false);
  if (!bytes.count_member.empty()) {
    count = "read." + bytes.count_member;
    text = fmt::format(
        "  {} = {};\n", count,
        first == 0 ? "length" : fmt::format("static_cast<uint8_t>(length - {})", first));
  }
  return text +
         fmt::format("  for (uint8_t i = 0; i < {}; ++i) {{\n    read.{}[i] = bytes[{}i];\n  }}\n",
                     count, bytes.member, first == 0 ? "" : fmt::format("{} + ", first));
}

/// Why bytes are no such message, by length and tag.
std::vector<std::string> shape_faults(const MessageKind& message) {
  std::vector<std::string> faults;
  if (message.min_length == message.max_length) {
    faults.push_back(fmt::format("length != {}", message.max_length));
  } else {
    if (message.min_length > 0) {
      faults.push_back(fmt::format("length < {}", message.min_length));
    }
    faults.push_back(fmt::format("length > {}", message.max_length));
  }
  if (message.tag) {
    faults.push_back(fmt::format("bytes[0] != {}", *message.tag));
  }
  return faults;
}

std::string refuse_if(const std::vector<std::string>& faults) {
  return faults.empty() ? ""
                        : fmt::format("  if ({}) {{\n    return false;\n  }}\n",
                                      filled(faults, " ||", "      "));
}

/// When a value is out of range: "from.shoulder > 180".
/// @param bits that the variable can hold: what no value of it can be is not asked.
std::vector<std::string> range_faults(const FieldNames& names, const std::string& variable,
                                      unsigned bits) {
  const Field& field = *names.field;
  if (!names.choice_type.empty()) {
    return {fmt::format("!is_valid({})", variable)};
  }
  const bool is_signed = field.form == Field::Form::signed_number;
  const std::int64_t lowest = is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
  const std::int64_t highest = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
  std::vector<std::string> faults;
  if (field.minimum > lowest) {
    faults.push_back(fmt::format("{} < {}", variable, literal(field.minimum, is_signed)));
  }
  if (field.maximum < highest) {
    faults.push_back(fmt::format("{} > {}", variable, literal(field.maximum, is_signed)));
  }
  return faults;
}

}  // namespace

Scope direction_scope() {
  return {"AnyMessage", "pack", "unpack", "length_of", "is_valid"};
}

MessageNames names_of(const MessageKind& message, Scope& scope) {
  MessageNames names{
      &message, scope.add(type_identifier(message.name)), scope.add(identifier(message.name)), {}};
  Scope members{names.type, "length", "minimum_length", "tag"};
  for (const Field& field : message.fields) {
    FieldNames added{&field, {}, {}, {}, {}};
    if (field.form == Field::Form::choice) {
      // No member may have the name of another's type.
      added.choice_type = scope.add(type_identifier(message.name + '-' + field.name));
      members.add(added.choice_type);
      Scope choices;
      for (const Choice& choice : field.choices) {
        added.choices.push_back(choices.add(identifier(choice.name)));
      }
    }
    names.fields.push_back(std::move(added));
  }
  for (FieldNames& field : names.fields) {
    field.member = members.add(identifier(field.field->name));
  }
  for (FieldNames& field : names.fields) {
    if (is_bytes(*field.field) && field.field->minimum != field.field->maximum) {
      field.count_member = members.add(field.member + "_length");
    }
  }
  return names;
}

std::string filled(const std::vector<std::string>& parts, const std::string& separator,
                   const std::string& indent) {
  constexpr std::size_t longest_line = 95;
  std::string text;
  std::size_t column = indent.size();
  for (const std::string& part : parts) {
    if (!text.empty()) {
      const bool fits = column + separator.size() + part.size() < longest_line;
      text += separator;
      text += fits ? " " : "\n";
      text += fits ? "" : indent;
      column = fits ? column + separator.size() + 1 : indent.size();
    }
    text += part;
    column += part.size();
  }
  return text;
}

std::string literal(std::int64_t value, bool is_signed) {
  constexpr std::int64_t int16_largest = 32767;
  constexpr std::int64_t uint16_largest = 65535;
  constexpr std::int64_t int32_largest = 2147483647;
  if (value < -int32_largest) {
    return fmt::format("-{}L - 1", int32_largest);
  }
  if (value <= int16_largest && value >= -int16_largest) {
    return fmt::format("{}", value);
  }
  if (is_signed) {
    return fmt::format("{}L", value);
  }
  return fmt::format("{}{}", value, value <= uint16_largest ? "U" : "UL");
}

std::string type_of(const FieldNames& names) {
  if (!names.choice_type.empty()) {
    return names.choice_type;
  }
  const bool is_signed = names.field->form == Field::Form::signed_number;
  return is_bytes(*names.field)
             ? "uint8_t"
             : fmt::format("{}int{}_t", is_signed ? "" : "u", type_bits(*names.field));
}

std::string choice_check(const FieldNames& names) {
  const std::vector<Choice>& choices = names.field->choices;
  std::vector<std::string> conditions;
  if (has_no_gap(choices)) {
    const auto [smallest, largest] =
        std::minmax_element(names.field->choices.begin(), names.field->choices.end(),
                            [](const Choice& a, const Choice& b) { return a.raw < b.raw; });
    if (smallest->raw > 0) {
      conditions.push_back(fmt::format("static_cast<uint8_t>(value) >= {}", smallest->raw));
    }
    if (largest->raw < 255) {
      conditions.push_back(fmt::format("static_cast<uint8_t>(value) <= {}", largest->raw));
    }
    return conditions.empty() ? always : fmt::format("{}", fmt::join(conditions, " && "));
  }
  for (const std::string& choice : names.choices) {
    conditions.push_back(fmt::format("value == {}::{}", names.choice_type, choice));
  }
  return filled(conditions, " ||", "         ");
}

std::string pack_function(const MessageNames& names) {
  std::vector<std::string> faults;
  for (const FieldNames& field : names.fields) {
    if (is_bytes(*field.field)) {
      if (!field.count_member.empty()) {
        const Field& count = *field.field;
        if (count.minimum > 0) {
          faults.push_back(fmt::format("from.{} < {}", field.count_member, count.minimum));
        }
        faults.push_back(fmt::format("from.{} > {}", field.count_member, count.maximum));
      }
      continue;
    }
    const auto more = range_faults(field, "from." + field.member, type_bits(*field.field));
    faults.insert(faults.end(), more.begin(), more.end());
  }
  const bool reads = !names.fields.empty();
  const bool writes = names.message->max_length > 0;
  std::string text = fmt::format("inline bool pack(const {}&{}, uint8_t*{}) {{\n", names.type,
                                 reads ? " from" : "", writes ? " bytes" : "");
  text += refuse_if(faults);
  if (names.message->tag) {
    text += fmt::format("  bytes[0] = {};\n", *names.message->tag);
  }
  return text + pack_fields(names) + "  return true;\n}\n";
}

std::string unpack_function(const MessageNames& names) {
  std::string reading;
  std::vector<std::string> faults;
  for (const FieldNames& field : names.fields) {
    if (is_bytes(*field.field)) {
      reading += unpack_bytes(field);
      continue;
    }
    const std::string variable = "read." + field.member;
    reading += fmt::format("  {} = {};\n", variable, read_field(field));
    const auto more = range_faults(field, variable, field.field->width);
    faults.insert(faults.end(), more.begin(), more.end());
  }
  const bool uses_bytes = names.message->tag || !reading.empty();
  std::string text =
      fmt::format("inline bool unpack(const uint8_t*{}, uint8_t length, {}&{}) {{\n",
                  uses_bytes ? " bytes" : "", names.type, reading.empty() ? "" : " to");
  if (reading.empty() && !names.message->tag) {
    return text + "  return length == 0;\n}\n";
  }
  text += refuse_if(shape_faults(*names.message));
  if (!reading.empty()) {
    // Bytes need not fill their array.
    const bool is_partial =
        std::any_of(names.fields.begin(), names.fields.end(),
                    [](const auto& field) { return !field.count_member.empty(); });
    text += fmt::format("  {} read{};\n{}{}  to = read;\n", names.type, is_partial ? " = {}" : "",
                        reading, refuse_if(faults));
  }
  return text + "  return true;\n}\n";
}

}  // namespace roio::cli::header
