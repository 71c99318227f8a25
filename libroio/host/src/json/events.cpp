#include "json/events.hpp"

#include <charconv>
#include <chrono>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "text/decimal.hpp"
#include "text/quote.hpp"
#include "text/seconds.hpp"

namespace roio {
namespace {

constexpr std::size_t max_bare_value = 40;

// A number with an exponent is only as exact as a double is; rounded to the microsecond.
std::optional<Timestamp> read_rounded_seconds(std::string_view number) {
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  constexpr double latest_s = 9223372036.0;
  if (error != std::errc() || !(value >= 0 && value <= latest_s)) {
    return std::nullopt;
  }
  return Timestamp(std::chrono::microseconds(std::llround(value * 1e6)));
}

std::optional<Timestamp> read_timestamp(std::string_view number) {
  if (number.find_first_of("eE") != std::string_view::npos) {
    return read_rounded_seconds(number);
  }
  const std::size_t dot = number.find('.');
  const std::string_view seconds = number.substr(0, dot);
  const std::string_view fraction = number.substr(std::min(dot, number.size() - 1) + 1);
  return is_digits(seconds) ? read_seconds(seconds, fraction) : std::nullopt;
}

// The parser may give a number with the locale's own decimal point.
std::string with_point(std::string number) {
  for (char& character : number) {
    if (!is_digit(character) &&
        std::string_view("+-eE").find(character) == std::string_view::npos) {
      character = '.';
    }
  }
  return number;
}

std::string field_names() {
  std::string names;
  for (const FieldRule& rule : field_rules) {
    names += std::string(names.empty() ? "" : ", ") + rule.name;
  }
  return names;
}

}  // namespace

bool JsonEvents::null() {
  return refuse("null");
}

bool JsonEvents::boolean(bool value) {
  if (place_ != Place::field || field_ != JsonField::is_broadcast) {
    return refuse(value ? "true" : "false");
  }
  fields_.is_broadcast = value;
  return true;
}

// Comes for numbers with a minus only.
bool JsonEvents::number_integer(number_integer_t value) {
  return refuse(value == 0 ? "-0" : std::to_string(value));
}

bool JsonEvents::number_unsigned(number_unsigned_t value) {
  if (place_ == Place::data) {
    return data_byte(value);
  }
  if (place_ == Place::field) {
    switch (field_) {
      case JsonField::address:
        return integer(value, broadcast_node, fields_.address);
      case JsonField::subnet:
        return integer(value, max_subnet, fields_.subnet);
      case JsonField::message_length:
        return integer(value, max_data_length, fields_.message_length);
      case JsonField::timestamp:
        return timestamp(std::to_string(value));
      default:
        break;
    }
  }
  return refuse(std::to_string(value));
}

bool JsonEvents::number_float(number_float_t /*value*/, const string_t& text) {
  const std::string number = with_point(text);
  const bool is_timestamp = place_ == Place::field && field_ == JsonField::timestamp;
  return is_timestamp ? timestamp(number) : refuse(number);
}

bool JsonEvents::string(string_t& value) {
  if (place_ != Place::field) {
    return refuse(quote(value));
  }
  switch (field_) {
    case JsonField::type:
      return value == "Roio" || refuse(quote(value));
    case JsonField::subnet:
    case JsonField::address:
      return refuse_module(value);
    case JsonField::priority: {
      const Parsed<Priority> priority = parse_priority(value);
      fields_.priority = priority ? *priority : Priority::normal;
      return priority || refuse(quote(value));
    }
    case JsonField::message_class:
      return message_class(value);
    case JsonField::source:
      return address(parse_source(value), fields_.source);
    case JsonField::destination:
      return address(parse_address(value), fields_.destination);
    default:
      return refuse(quote(value));
  }
}

bool JsonEvents::binary(binary_t& /*value*/) {
  return refuse("binary data");
}

bool JsonEvents::start_object(std::size_t /*size*/) {
  if (place_ != Place::start) {
    return refuse("an object");
  }
  place_ = Place::field;
  return true;
}

bool JsonEvents::key(string_t& name) {
  for (const FieldRule& rule : field_rules) {
    if (name == rule.name) {
      return begin(rule.field);
    }
  }
  return fail("JSON field " + quote(name) + ": unknown; expected one of " + field_names());
}

bool JsonEvents::end_object() {
  place_ = Place::end;
  return true;
}

bool JsonEvents::start_array(std::size_t /*size*/) {
  if (place_ != Place::field || field_ != JsonField::data) {
    return refuse("an array");
  }
  place_ = Place::data;
  return true;
}

bool JsonEvents::end_array() {
  place_ = Place::field;
  if (data_count_ > fields_.data.data.size()) {
    return fail(field_error(JsonField::data,
                            std::to_string(data_count_) + " bytes; a frame carries at most 8"));
  }
  fields_.data.length = static_cast<std::uint8_t>(data_count_);
  return true;
}

bool JsonEvents::parse_error(std::size_t position, const std::string& last_token,
                             const nlohmann::json::exception& error) {
  constexpr int number_overflow = 406;
  if (error.id == number_overflow) {
    return refuse(with_point(last_token));
  }
  syntax_error_ = position > 0 ? position - 1 : 0;  // position counts the character in the way
  return false;
}

bool JsonEvents::fail(std::string message) {
  error_ = ParseError{std::move(message), 0};
  return false;
}

// A value that does not belong where it stands.
bool JsonEvents::refuse(const std::string& value) {
  const bool is_bare = !value.starts_with('"');
  const std::string shown = is_bare && value.size() > max_bare_value ? quote(value) : value;
  switch (place_) {
    case Place::field:
      return fail(unexpected(field_, shown));
    case Place::data:
      return fail(field_error(JsonField::data, shown + " at index " + std::to_string(data_count_) +
                                                   "; expected integers 0..255"));
    case Place::start:
    case Place::end:
      break;
  }
  return fail("JSON: " + shown + R"(; expected an object such as {"type":"Roio",...})");
}

bool JsonEvents::refuse_module(const std::string& name) {
  return refuse(quote(name) + " addresses a software module, which is on no bus");
}

bool JsonEvents::begin(JsonField field) {
  bool& seen = fields_.seen[static_cast<std::size_t>(field)];
  if (seen) {
    return fail(field_error(field, "given twice; expected once"));
  }
  seen = true;
  field_ = field;
  return true;
}

bool JsonEvents::integer(std::uint64_t value, std::uint8_t max, std::uint8_t& out) {
  out = static_cast<std::uint8_t>(value);
  return value <= max || refuse(std::to_string(value));
}

bool JsonEvents::data_byte(std::uint64_t value) {
  if (value > UINT8_MAX) {
    return refuse(std::to_string(value));
  }
  if (data_count_ < fields_.data.data.size()) {
    fields_.data.data[data_count_] = static_cast<std::uint8_t>(value);
  }
  ++data_count_;
  return true;
}

bool JsonEvents::timestamp(const std::string& number) {
  fields_.timestamp = read_timestamp(number);
  return fields_.timestamp || refuse(number);
}

bool JsonEvents::message_class(const std::string& value) {
  const Parsed<MessageClass> parsed = parse_class(value);
  if (!parsed || *parsed == MessageClass::reserved) {
    return refuse(quote(value));
  }
  fields_.message_class = *parsed;
  return true;
}

bool JsonEvents::address(const Parsed<Address>& parsed, Address& out) {
  if (!parsed) {
    return fail(field_error(field_, parsed.error().message));
  }
  out = *parsed;
  return true;
}

}  // namespace roio
