#ifndef ROIO_ROBOT_AT_HPP
#define ROIO_ROBOT_AT_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/source.hpp"
#include "robot/value.hpp"

namespace roio::robot_file {

/// A value of a document at its place. Asked for what it is worth, it says so or throws Refused
/// with file, line, place, what was there and what was expected. Source and document outlive it.
class At {
 public:
  At(const Source& source, const Value& value, std::string place)
      : source_(&source), value_(&value), place_(std::move(place)) {}

  [[nodiscard]] const Value& value() const { return *value_; }
  [[nodiscard]] const std::string& name() const { return value_->name; }
  [[nodiscard]] bool is(Value::Type type) const { return value_->type == type; }

  /// Of an array and of an object.
  [[nodiscard]] std::vector<At> children() const;

  /// @param expected said when it is another type.
  [[nodiscard]] const std::string& text(const std::string& expected) const;
  /// A name by name_rule.
  [[nodiscard]] const std::string& identifier() const;
  /// A text of one line, of `min` to `max` characters.
  [[nodiscard]] const std::string& line(std::size_t min, std::size_t max) const;
  /// A number without sign, point and exponent.
  [[nodiscard]] std::uint64_t whole(std::uint64_t min, std::uint64_t max) const;

  /// "PLACE: "u9"; expected u8 or u16"
  [[noreturn]] void refuse(const std::string& expected) const;
  /// "PLACE: " and what is wrong there.
  [[noreturn]] void wrong(const std::string& what) const;
  /// What stands there, in a few words: "u9", 7, null, an object.
  [[nodiscard]] std::string shown() const;

 private:
  const Source* source_;
  const Value* value_;
  std::string place_;
};

/// An object whose names are all known.
class Object {
 public:
  using Names = std::vector<std::string>;

  /// @throws Refused: no object; a name that is not in `known`, with the nearest that is.
  Object(At at, const Names& known);

  [[nodiscard]] const At& at() const { return at_; }
  [[nodiscard]] std::optional<At> find(std::string_view name) const;
  /// @throws Refused: there is none. @param expected what would be right: a name, a number.
  [[nodiscard]] At need(std::string_view name, const std::string& expected) const;
  /// A text for people; empty: there is none.
  [[nodiscard]] std::string line(std::string_view name, std::size_t min, std::size_t max) const;

 private:
  At at_;
};

/// The object that a file is, and that this format version reads.
Object file_object(const Source& source, const Value& document, const Object::Names& known);

}  // namespace roio::robot_file

#endif
