#ifndef ROIO_ROBOT_VALUE_RULE_HPP
#define ROIO_ROBOT_VALUE_RULE_HPP

#include <cstdint>
#include <roio/kind.hpp>
#include <string>
#include <string_view>
#include <variant>

namespace roio::robot_file {

/// Why a value is not one of a field's: "181 deg; expected a number 0..180 deg".
struct NotOfField {
  std::string message;
};

/// What goes on the wire for a value that people or programs say.
using RawOrNot = std::variant<std::int64_t, NotOfField>;

/// "a number 0..180 deg", "one of off, on", "0 to 8 bytes".
std::string expected_of(const Field& field);

/// The step next to a number, halves away from zero; a choice by its name; of bytes their number.
RawOrNot raw_of(const Field& field, const FieldValue& value);

/// A number as it is typed: a step, or the text of one where that is rounded.
RawOrNot raw_of_number_text(const Field& field, std::string_view text);

/// What people and programs say for what is on the wire; not of bytes.
FieldValue value_of(const Field& field, std::int64_t raw);

/// @return null: none.
const Choice* find_choice(const Field& field, std::string_view name) noexcept;
const Choice* find_choice(const Field& field, std::int64_t raw) noexcept;

}  // namespace roio::robot_file

#endif
