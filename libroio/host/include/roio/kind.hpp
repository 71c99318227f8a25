/// Kind: what a kind of board hears and says, in messages with named fields. Target roio::robot.
///
///   const auto kind = roio::load_kind("servo-arm.kind.json");
///   const roio::MessageKind* angles = kind->hears("angles");
///   const auto bytes = roio::pack(*angles, {{"shoulder", 90}, {"elbow", 45}, {"hand", 0}});
///
/// A message is told from the others of its direction by its length, and by its tag where lengths
/// agree. Fields follow each other without a gap, the highest bit and the highest byte first.
/// Source: docs/robot-file.md.
#ifndef ROIO_KIND_HPP
#define ROIO_KIND_HPP

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <roio/export.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace roio {

/// A step of a field, in its unit: what one more on the wire means. Both 1..1,000,000.
struct Fraction {
  std::uint32_t numerator = 1;
  std::uint32_t denominator = 1;
};

struct Choice {
  std::string name;
  std::uint8_t raw = 0;
};

struct Field {
  enum class Form : std::uint8_t {
    number,         ///< u8, u16, u24, u32, and bits: 0 .. 2^width - 1.
    signed_number,  ///< i8, i16, i24, i32: two's complement.
    choice,         ///< enum: one of `choices`.
    bytes,          ///< All that is left of the message, as it is; the last field.
  };

  std::string name;
  std::string description;
  std::string unit;  ///< "deg"; empty: none.
  Form form = Form::number;
  std::uint8_t first_bit = 0;  ///< 0..63; 0 is the highest of the first byte.
  std::uint8_t width = 8;      ///< In bits: 1..32; of bytes 8 times their largest number, 0..64.
  Fraction scale;
  /// On the wire, before scaling; of bytes their smallest and largest number.
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  std::vector<Choice> choices;
};

/// What a message holds. Named so since a Message is one that is sent.
struct MessageKind {
  std::string name;
  std::string description;
  std::optional<std::uint8_t> tag;  ///< The first byte; the fields follow it.
  std::vector<Field> fields;
  std::uint8_t min_length = 0;  ///< 0..8, with the tag. Differs from the largest one only where the
  std::uint8_t max_length = 0;  ///< last field is of form bytes.

  [[nodiscard]] ROIO_EXPORT const Field* find(std::string_view field) const noexcept;
  /// Whether these are the length and the tag of such a message.
  [[nodiscard]] ROIO_EXPORT bool fits(std::span<const std::uint8_t> data) const noexcept;
};

struct Kind {
  std::string name;  ///< "servo-arm".
  std::string description;
  std::vector<MessageKind> heard;  ///< What such a board understands.
  std::vector<MessageKind> said;   ///< What it sends.
  std::vector<Field> settings;     ///< What a robot can set; nothing of it is on the wire.

  /// By name. @return null: there is none.
  [[nodiscard]] ROIO_EXPORT const MessageKind* hears(std::string_view message) const noexcept;
  [[nodiscard]] ROIO_EXPORT const MessageKind* says(std::string_view message) const noexcept;
  /// By what came. At most one fits.
  [[nodiscard]] ROIO_EXPORT const MessageKind* hears(
      std::span<const std::uint8_t> data) const noexcept;
  [[nodiscard]] ROIO_EXPORT const MessageKind* says(
      std::span<const std::uint8_t> data) const noexcept;
};

/// A value as people and programs say it: a number in the field's unit, a choice by name, or bytes.
class FieldValue {
 public:
  template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
  FieldValue(Number number) : content_(static_cast<double>(number)) {}
  FieldValue(std::string choice) : content_(std::move(choice)) {}
  FieldValue(std::string_view choice) : content_(std::string(choice)) {}
  FieldValue(const char* choice) : content_(std::string(choice)) {}
  FieldValue(const Bytes& bytes) : content_(bytes) {}

  [[nodiscard]] const double* number() const noexcept { return std::get_if<double>(&content_); }
  [[nodiscard]] const std::string* choice() const noexcept {
    return std::get_if<std::string>(&content_);
  }
  [[nodiscard]] const Bytes* bytes() const noexcept { return std::get_if<Bytes>(&content_); }

 private:
  std::variant<double, std::string, Bytes> content_;
};

struct NamedValue {
  std::string name;
  FieldValue value;
};

/// One field of a message that came.
struct Reading {
  const Field* field = nullptr;  ///< Of the kind, which outlives this.
  std::int64_t raw = 0;          ///< As on the wire; of bytes their number.
  Bytes bytes{};                 ///< Of form bytes.

  /// In the field's unit; of a choice the number on the wire.
  [[nodiscard]] ROIO_EXPORT double value() const noexcept;
  /// Within minimum and maximum; one of the choices. Boards can send others, and they are shown.
  [[nodiscard]] ROIO_EXPORT bool is_valid() const noexcept;
  /// "90", "-12.5", "on", "5A2D00", without the unit. Exact where the scale is a decimal fraction,
  /// else with as many digits as tell one step from the next. A choice without a name: its number.
  [[nodiscard]] ROIO_EXPORT std::string text() const;
};

/// Puts values into bytes. Each field must be named once; only bytes may be left out, when their
/// smallest number is 0. A number is rounded to the nearest step, halves away from zero.
/// @return an error names the field, and says what was expected: a name, a value in range, one
///         value each.
ROIO_EXPORT Parsed<Bytes> pack(const MessageKind& message, std::span<const NamedValue> values);
ROIO_EXPORT Parsed<Bytes> pack(const MessageKind& message,
                               std::initializer_list<NamedValue> values);

/// @param data one that message.fits().
/// @return the fields in their order; what they refer to is `message`.
ROIO_EXPORT std::vector<Reading> unpack(const MessageKind& message,
                                        std::span<const std::uint8_t> data);

/// A value as a person types it: a number, the name of a choice, or bytes in hexadecimal. What
/// Reading::text() gives of a valid value is one. A number between two steps is refused, and both
/// are named.
ROIO_EXPORT Parsed<FieldValue> parse_value(const Field& field, std::string_view text);

/// Reads a kind. @param origin what errors call it: a file's name.
/// @return an error: "servo-arm.kind.json:7: hears.angles.fields[0].type: "u9"; expected u8, ...":
///         file, line, the place in it, what was there and what was expected. A field that the
///         format does not have is one, and the nearest name that it has is suggested; so are two
///         messages of one direction that cannot be told apart. ParseError::offset is that of the
///         value; 0 where the file as a whole is refused. Throws nothing but std::bad_alloc.
ROIO_EXPORT Parsed<Kind> parse_kind(std::string_view text, std::string_view origin);
/// The same from a file, whose name must be that of the kind and ".kind.json".
ROIO_EXPORT Parsed<Kind> load_kind(const std::filesystem::path& file);

}  // namespace roio

#endif
