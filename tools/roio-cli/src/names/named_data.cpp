#include "names/named_data.hpp"

#include <string_view>
#include <vector>

namespace roio::cli {
namespace {

// Also such as are wrong: what is said of them then speaks of bytes.
bool is_meant_as_bytes(std::string_view word) {
  constexpr std::string_view of_bytes = "0123456789abcdefABCDEF. -";
  return word.find_first_not_of(of_bytes) == std::string_view::npos ||
         (word.front() >= '0' && word.front() <= '9');
}

std::string fields_of(const MessageKind& message) {
  std::string names;
  for (const Field& field : message.fields) {
    names += (names.empty() ? "" : ", ") + field.name;
  }
  return names.empty() ? "it has no fields" : "it has " + names;
}

/// FIELD=VALUE
Parsed<NamedValue> parse_field_word(const MessageKind& message, const std::string& word) {
  const std::size_t sign = word.find('=');
  if (sign == std::string::npos) {
    return ParseError{
        message.name + ": expected FIELD=VALUE, found " + quote(word) + "; " + fields_of(message),
        0};
  }
  const std::string name = word.substr(0, sign);
  const Field* const field = message.find(name);
  if (field == nullptr) {
    return ParseError{message.name + ": no field " + quote(name) + "; " + fields_of(message), 0};
  }
  const auto value = parse_value(*field, std::string_view(word).substr(sign + 1));
  if (!value) {
    return ParseError{message.name + "." + value.error().message, 0};  // its field comes first
  }
  return NamedValue{name, *value};
}

}  // namespace

Parsed<std::optional<Bytes>> parse_named_data(const Robot& robot, Address source,
                                              Address destination,
                                              std::span<const std::string> words) {
  if (words.empty()) {
    return std::optional<Bytes>();
  }
  const auto message = robot.message(source, destination, words.front());
  if (!message) {
    return is_meant_as_bytes(words.front()) ? Parsed<std::optional<Bytes>>(std::optional<Bytes>())
                                            : Parsed<std::optional<Bytes>>(message.error());
  }
  std::vector<NamedValue> values;
  for (const std::string& word : words.subspan(1)) {
    auto value = parse_field_word(**message, word);
    if (!value) {
      return value.error();
    }
    values.push_back(*value);
  }
  const auto bytes = pack(**message, values);
  if (!bytes) {
    return bytes.error();
  }
  if (const auto other = robot.objection(source, destination, **message, *bytes)) {
    return *other;
  }
  return std::optional<Bytes>(*bytes);
}

}  // namespace roio::cli
