#include "robot/at.hpp"

#include <charconv>
#include <system_error>

#include "robot/alike.hpp"
#include "robot/document.hpp"
#include "robot/limits.hpp"
#include "robot/name.hpp"
#include "text/decimal.hpp"

namespace roio::robot_file {
namespace {

constexpr std::size_t max_bare_value = 40;

const Value* find_child(const Value& object, std::string_view name) {
  for (const Value& child : object.children) {
    if (child.name == name) {
      return &child;
    }
  }
  return nullptr;
}

void check_version(const At& at) {
  if (!at.is(Value::Type::number) || at.value().text != std::to_string(format_version)) {
    at.refuse(std::to_string(format_version) + ", the version of the format that is read here");
  }
}

std::optional<std::uint64_t> read_whole(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = is_digits(text) && error == std::errc();
  return is_whole ? std::optional(value) : std::nullopt;
}

}  // namespace

std::vector<At> At::children() const {
  std::vector<At> out;
  for (std::size_t i = 0; i < value_->children.size(); ++i) {
    const Value& child = value_->children[i];
    out.emplace_back(*source_, child,
                     is(Value::Type::array) ? place_ + '[' + std::to_string(i) + ']'
                                            : place_in(place_, child.name));
  }
  return out;
}

const std::string& At::text(const std::string& expected) const {
  if (!is(Value::Type::text)) {
    refuse(expected);
  }
  return value_->text;
}

const std::string& At::identifier() const {
  if (!is_name(text(name_rule))) {
    refuse(name_rule);
  }
  return value_->text;
}

const std::string& At::line(std::size_t min, std::size_t max) const {
  const std::string expected = "a text of " +
                               (min == 0 ? "at most " : std::to_string(min) + " to ") +
                               std::to_string(max) + " characters, on one line";
  if (!is_line(text(expected), min, max)) {
    refuse(expected);
  }
  return value_->text;
}

std::uint64_t At::whole(std::uint64_t min, std::uint64_t max) const {
  const std::string expected = "a whole number " + std::to_string(min) + ".." + std::to_string(max);
  const auto number = is(Value::Type::number) ? read_whole(value_->text) : std::nullopt;
  if (!number || *number < min || *number > max) {
    const bool is_plain = value_->text.find_first_of(".eE") == std::string::npos;
    refuse(expected + (is(Value::Type::number) && !is_plain ? ", without point and exponent" : ""));
  }
  return *number;
}

void At::refuse(const std::string& expected) const {
  wrong(shown() + "; expected " + expected);
}

void At::wrong(const std::string& what) const {
  source_->refuse(value_->offset, place_, what);
}

std::string At::shown() const {
  switch (value_->type) {
    case Value::Type::text:
      return quote(value_->text);
    case Value::Type::array:
      return "an array";
    case Value::Type::object:
      return "an object";
    case Value::Type::null:
    case Value::Type::boolean:
    case Value::Type::number:
      break;
  }
  return value_->text.size() > max_bare_value ? quote(value_->text) : value_->text;
}

Object::Object(At at, const Names& known) : at_(std::move(at)) {
  if (!at_.is(Value::Type::object)) {
    at_.refuse("an object");
  }
  for (const At& child : at_.children()) {
    bool is_known = false;
    for (const std::string& name : known) {
      is_known = is_known || name == child.name();
    }
    if (!is_known) {
      child.wrong("unknown field; " + advice(child.name(), known, "expected none"));
    }
  }
}

std::optional<At> Object::find(std::string_view name) const {
  for (const At& child : at_.children()) {
    if (child.name() == name) {
      return child;
    }
  }
  return std::nullopt;
}

At Object::need(std::string_view name, const std::string& expected) const {
  const auto child = find(name);
  if (!child) {
    at_.wrong("no field \"" + std::string(name) + "\"; expected " + expected);
  }
  return *child;
}

std::string Object::line(std::string_view name, std::size_t min, std::size_t max) const {
  const auto child = find(name);
  return child ? child->line(min, max) : std::string();
}

Object file_object(const Source& source, const Value& document, const Object::Names& known) {
  const At at(source, document, "");
  if (!at.is(Value::Type::object)) {
    at.refuse("an object");
  }
  // Another version may have other fields: which one it is comes first.
  if (const Value* version = find_child(document, "roio")) {
    check_version(At(source, *version, "roio"));
  }
  Object object(at, known);
  static_cast<void>(object.need("roio", "1, the version of the format"));
  if (const auto schema = object.find("$schema")) {
    static_cast<void>(schema->text("the address of a schema"));
  }
  return object;
}

}  // namespace roio::robot_file
