#include "robot/value_rule.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "robot/alike.hpp"
#include "robot/exact.hpp"

namespace roio::robot_file {
namespace {

constexpr std::size_t max_bare_number = 40;

bool is_number(const Field& field) {
  return field.form == Field::Form::number || field.form == Field::Form::signed_number;
}

std::string with_unit(const std::string& number, const Field& field) {
  return number + (field.unit.empty() ? "" : " " + field.unit);
}

NotOfField unexpected(const std::string& value, const Field& field) {
  return {value + "; expected " + expected_of(field)};
}

std::vector<std::string> choice_names(const Field& field) {
  std::vector<std::string> names;
  for (const Choice& choice : field.choices) {
    names.push_back(choice.name);
  }
  return names;
}

/// As short as it can be read back.
std::string shown(double number) {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), written.ptr};
}

std::string shown(const FieldValue& value) {
  if (const double* number = value.number()) {
    return shown(*number);
  }
  if (const std::string* choice = value.choice()) {
    return quote(*choice);
  }
  return std::to_string(value.bytes()->length) + " bytes";
}

/// The nearest step; past 2^60 as that, which no field holds. Not a number stays none.
double nearest_step(double number, Fraction scale) {
  constexpr double past_all = 1152921504606846976.0;
  const double step = std::round(number * scale.denominator / scale.numerator);
  return std::fmax(-past_all, std::fmin(past_all, step));
}

RawOrNot raw_of_number(const Field& field, double number) {
  const double step = nearest_step(number, field.scale);
  const auto raw = std::isnan(number) ? field.minimum : static_cast<std::int64_t>(step);
  if (std::isnan(number) || raw < field.minimum || raw > field.maximum) {
    return unexpected(with_unit(shown(number), field), field);
  }
  return raw;
}

RawOrNot raw_of_choice(const Field& field, const std::string& name) {
  if (const Choice* choice = find_choice(field, name)) {
    return choice->raw;
  }
  return NotOfField{quote(name) + "; " + advice(name, choice_names(field), "expected nothing")};
}

bool is_text_of(std::int64_t raw, const Field& field, const Decimal& number) {
  return read_decimal_number(step_text(raw, field.scale)) == number;
}

}  // namespace

std::string expected_of(const Field& field) {
  if (field.form == Field::Form::choice) {
    return (field.choices.size() == 1 ? "" : "one of ") + listed(choice_names(field));
  }
  if (field.form == Field::Form::bytes) {
    return field.minimum == field.maximum
               ? std::to_string(field.maximum) + " bytes"
               : std::to_string(field.minimum) + " to " + std::to_string(field.maximum) + " bytes";
  }
  return with_unit("a number " + step_text(field.minimum, field.scale) + ".." +
                       step_text(field.maximum, field.scale),
                   field);
}

RawOrNot raw_of(const Field& field, const FieldValue& value) {
  if (const double* number = value.number(); number != nullptr && is_number(field)) {
    return raw_of_number(field, *number);
  }
  if (const std::string* name = value.choice();
      name != nullptr && field.form == Field::Form::choice) {
    return raw_of_choice(field, *name);
  }
  const Bytes* bytes = value.bytes();
  if (bytes != nullptr && field.form == Field::Form::bytes && bytes->length >= field.minimum &&
      bytes->length <= field.maximum) {
    return bytes->length;
  }
  return unexpected(shown(value), field);
}

RawOrNot raw_of_number_text(const Field& field, std::string_view text) {
  const auto number = read_decimal_number(text);
  if (!number) {
    return unexpected(quote(text), field);
  }
  Steps steps = steps_next_to(*number, field.scale);
  const bool is_past_all = steps.lower < field.minimum - 1 || steps.upper > field.maximum + 1;
  if (!is_past_all && is_text_of(steps.lower, field, *number)) {
    steps.upper = steps.lower;
  } else if (!is_past_all && is_text_of(steps.upper, field, *number)) {
    steps.lower = steps.upper;
  }
  const std::string there =
      with_unit(text.size() > max_bare_number ? quote(text) : std::string(text), field);
  if (steps.lower < field.minimum || steps.upper > field.maximum) {
    return unexpected(there, field);
  }
  if (steps.is_exact()) {
    return steps.lower;
  }
  return NotOfField{there + " is between two steps; expected " +
                    step_text(steps.lower, field.scale) + " or " +
                    step_text(steps.upper, field.scale)};
}

FieldValue value_of(const Field& field, std::int64_t raw) {
  const Choice* choice = find_choice(field, raw);
  return choice != nullptr ? FieldValue(choice->name) : FieldValue(step_value(raw, field.scale));
}

const Choice* find_choice(const Field& field, std::string_view name) noexcept {
  for (const Choice& choice : field.choices) {
    if (choice.name == name) {
      return &choice;
    }
  }
  return nullptr;
}

const Choice* find_choice(const Field& field, std::int64_t raw) noexcept {
  for (const Choice& choice : field.choices) {
    if (choice.raw == raw) {
      return &choice;
    }
  }
  return nullptr;
}

}  // namespace roio::robot_file
