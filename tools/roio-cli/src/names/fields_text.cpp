#include "names/fields_text.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

namespace roio::cli {
namespace {

void append(Buffer& out, std::string_view text) {
  out.append(text.data(), text.data() + text.size());
}

std::string text_of_raw(const Field& field, std::int64_t raw) {
  return Reading{&field, raw, {}}.text();
}

/// " (expected 0..180)"
std::string objection_to(const Reading& reading) {
  const Field& field = *reading.field;
  if (reading.is_valid()) {
    return {};
  }
  if (field.form == Field::Form::choice) {
    return " (no choice has it)";
  }
  return " (expected " + text_of_raw(field, field.minimum) + ".." +
         text_of_raw(field, field.maximum) + ")";
}

}  // namespace

void append_fields(Buffer& out, const NamedMessage& message) {
  std::string_view separator;
  for (const Reading& reading : message.readings) {
    const Field& field = *reading.field;
    fmt::format_to(std::back_inserter(out), "{}{}={}{}{}", separator, field.name, reading.text(),
                   field.unit.empty() ? "" : " ", field.unit);
    append(out, objection_to(reading));
    separator = "  ";
  }
}

}  // namespace roio::cli
