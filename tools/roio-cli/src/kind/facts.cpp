#include "kind/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace roio::cli {

std::string origin(std::string_view made, std::string_view source) {
  return fmt::format("Made by `roio-cli {}` from {}: change that, and make this again.", made,
                     std::filesystem::path(source).filename().string());
}

std::string type_of(const Field& field) {
  switch (field.form) {
    case Field::Form::choice:
      return "enum";
    case Field::Form::bytes:
      return "bytes";
    case Field::Form::signed_number:
      return fmt::format("i{}", field.width);
    case Field::Form::number:
      break;
  }
  // A u8 and eight bits are the same.
  return field.width < 8 ? "bits" : fmt::format("u{}", field.width);
}

std::string range_of(const Field& field) {
  if (field.form == Field::Form::bytes) {
    return byte_count(field.minimum, field.maximum);
  }
  if (field.form == Field::Form::choice) {
    std::string text;
    for (const Choice& choice : field.choices) {
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", choice.name, choice.raw);
    }
    return text;
  }
  return fmt::format("{} to {}{}{}", in_unit(field, field.minimum), in_unit(field, field.maximum),
                     field.unit.empty() ? "" : " ", one_line(field.unit));
}

std::string byte_count(std::int64_t smallest, std::int64_t largest) {
  if (smallest != largest) {
    return fmt::format("{} to {} bytes", smallest, largest);
  }
  return fmt::format("{} byte{}", largest, largest == 1 ? "" : "s");
}

std::string length_of(const MessageKind& message) {
  return byte_count(message.min_length, message.max_length);
}

std::string in_unit(const Field& field, std::int64_t raw) {
  return Reading{&field, raw}.text();
}

std::string to_string(const Fraction& scale) {
  return scale.denominator == 1 ? fmt::format("{}", scale.numerator)
                                : fmt::format("{}/{}", scale.numerator, scale.denominator);
}

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, ' ');
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace roio::cli
