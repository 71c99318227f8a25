#include "robot/field_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <roio/frame.hpp>

#include "robot/alike.hpp"
#include "robot/exact.hpp"
#include "robot/limits.hpp"
#include "robot/name.hpp"
#include "robot/value_rule.hpp"
#include "text/decimal.hpp"

namespace roio::robot_file {
namespace {

using Names = Object::Names;

struct TypeRule {
  const char* name;
  Field::Form form;
  std::uint8_t width;      ///< Where the file says none.
  bool has_width = false;  ///< Whether it may say one.
};

constexpr std::array<TypeRule, 11> type_rules{{{"u8", Field::Form::number, 8},
                                               {"u16", Field::Form::number, 16},
                                               {"u24", Field::Form::number, 24},
                                               {"u32", Field::Form::number, 32},
                                               {"i8", Field::Form::signed_number, 8},
                                               {"i16", Field::Form::signed_number, 16},
                                               {"i24", Field::Form::signed_number, 24},
                                               {"i32", Field::Form::signed_number, 32},
                                               {"bits", Field::Form::number, 1, true},
                                               {"enum", Field::Form::choice, 8, true},
                                               {"bytes", Field::Form::bytes, 0}}};

constexpr const char* expected_type =
    "one of u8, u16, u24, u32, i8, i16, i24, i32, bits, enum, bytes";

const TypeRule& read_type(const At& at) {
  const std::string& name = at.text(expected_type);
  for (const TypeRule& rule : type_rules) {
    if (name == rule.name) {
      return rule;
    }
  }
  at.refuse(expected_type);
}

/// What a field of each type may have, "type" and "name" apart.
Names names_for(const TypeRule& rule) {
  Names names = {"name", "type", "description"};
  const auto add = [&names](std::initializer_list<const char*> more) {
    names.insert(names.end(), more.begin(), more.end());
  };
  if (rule.has_width) {
    add({"width"});
  }
  switch (rule.form) {
    case Field::Form::choice:
      add({"values"});
      break;
    case Field::Form::bytes:
      add({"minimum", "maximum"});
      break;
    case Field::Form::number:
    case Field::Form::signed_number:
      add({"scale", "unit", "minimum", "maximum"});
      break;
  }
  return names;
}

const Names& all_names() {
  static const Names names = {"name",  "type", "description", "width",  "values",
                              "scale", "unit", "minimum",     "maximum"};
  return names;
}

/// A name that other types have is told from one that none has.
Object object_of_type(const Object& object, const TypeRule& rule) {
  const Names known = names_for(rule);
  for (const At& child : object.at().children()) {
    if (std::find(known.begin(), known.end(), child.name()) == known.end()) {
      child.wrong(std::string("not for type ") + rule.name + "; expected " + listed(known));
    }
  }
  return object;
}

std::uint32_t read_part(const At& at, std::string_view part) {
  const auto value = read_decimal(part);
  if (!value || *value == 0 || *value > max_part) {
    at.refuse(R"(a whole number 1..1000000, or a fraction of two such as "1/10")");
  }
  return *value;
}

Fraction read_scale(const At& at) {
  const std::string_view text = at.value().text;
  if (at.is(Value::Type::number)) {
    return {read_part(at, text), 1};
  }
  const std::size_t slash = at.is(Value::Type::text) ? text.find('/') : std::string::npos;
  if (slash == std::string::npos) {
    return {read_part(at, ""), 1};  // which refuses it
  }
  return {read_part(at, text.substr(0, slash)), read_part(at, text.substr(slash + 1))};
}

struct Range {
  std::int64_t minimum;
  std::int64_t maximum;
};

Range range_of(Field::Form form, unsigned width) {
  if (form == Field::Form::signed_number) {
    const std::int64_t half = std::int64_t{1} << (width - 1);
    return {-half, half - 1};
  }
  return {0, (std::int64_t{1} << width) - 1};
}

std::string shown_range(Range range, Fraction scale) {
  return step_text(range.minimum, scale) + ".." + step_text(range.maximum, scale);
}

std::string shown_scale(Fraction scale) {
  return std::to_string(scale.numerator) +
         (scale.denominator == 1 ? "" : '/' + std::to_string(scale.denominator));
}

/// A limit in the unit, which must be a step. @param type what the type holds.
std::int64_t read_limit(const At& at, const Field& field, Range type) {
  const auto number =
      at.is(Value::Type::number) ? read_decimal_number(at.value().text) : std::nullopt;
  if (!number) {
    at.refuse("a number " + shown_range(type, field.scale));
  }
  const Steps steps = steps_next_to(*number, field.scale);
  if (steps.lower < type.minimum || steps.upper > type.maximum) {
    at.refuse("a number " + shown_range(type, field.scale) + ", which the type holds");
  }
  if (!steps.is_exact()) {
    at.refuse("a multiple of the scale, " + shown_scale(field.scale));
  }
  return steps.lower;
}

void read_number(const Object& object, Field& field) {
  field.unit = object.line("unit", 1, max_unit);
  if (const auto scale = object.find("scale")) {
    field.scale = read_scale(*scale);
  }
  const Range type = range_of(field.form, field.width);
  const auto minimum = object.find("minimum");
  const auto maximum = object.find("maximum");
  field.minimum = minimum ? read_limit(*minimum, field, type) : type.minimum;
  field.maximum = maximum ? read_limit(*maximum, field, type) : type.maximum;
  if (field.minimum > field.maximum) {
    (minimum ? *minimum : *maximum)
        .wrong("the minimum, " + step_text(field.minimum, field.scale) +
               ", is above the maximum, " + step_text(field.maximum, field.scale));
  }
}

void read_choices(const Object& object, Field& field) {
  const Range type = range_of(Field::Form::number, field.width);
  field.minimum = type.minimum;
  field.maximum = type.maximum;
  const At values = object.need("values", "an object, name to number");
  if (!values.is(Value::Type::object) || values.value().children.empty()) {
    values.refuse(R"(an object with a number for each name, such as {"off": 0, "on": 1})");
  }
  for (const At& value : values.children()) {
    if (!is_name(value.name(), FirstCharacter::letter_or_digit)) {
      value.wrong(std::string("not a name; expected ") + choice_rule);
    }
    const auto raw =
        static_cast<std::uint8_t>(value.whole(0, static_cast<std::uint64_t>(type.maximum)));
    for (const Choice& other : field.choices) {
      if (other.raw == raw) {
        value.wrong(std::to_string(raw) + " is that of " + quote(other.name) +
                    "; expected another number");
      }
    }
    field.choices.push_back({value.name(), raw});
  }
}

void read_bytes(const Object& object, Field& field, unsigned room) {
  if (room == 0) {
    object.at().wrong("no room is left in the 8 bytes of a message");
  }
  const auto minimum = object.find("minimum");
  const auto maximum = object.find("maximum");
  field.maximum = maximum ? static_cast<std::int64_t>(maximum->whole(1, room)) : room;
  field.minimum =
      minimum
          ? static_cast<std::int64_t>(minimum->whole(0, static_cast<std::uint64_t>(field.maximum)))
          : 0;
  field.width = static_cast<std::uint8_t>(8 * field.maximum);
}

/// All but where it is. @param room bytes left in the message; 0: bytes have no room.
Field read_field(const Object& object, const TypeRule& rule, unsigned room) {
  Field field;
  field.name = object.need("name", name_rule).identifier();
  field.description = object.line("description", 0, max_description);
  field.form = rule.form;
  const auto width = object.find("width");
  field.width = width ? static_cast<std::uint8_t>(width->whole(1, 8)) : rule.width;
  switch (rule.form) {
    case Field::Form::number:
    case Field::Form::signed_number:
      read_number(object, field);
      break;
    case Field::Form::choice:
      read_choices(object, field);
      break;
    case Field::Form::bytes:
      read_bytes(object, field, room);
      break;
  }
  return field;
}

void refuse_twin(const Object& object, const std::vector<Field>& fields, const std::string& name) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == name) {
      object.need("name", "")
          .wrong(quote(name) + " is the name of field " + std::to_string(i) +
                 ", too; expected another");
    }
  }
}

const TypeRule& type_of(const Object& object) {
  return read_type(object.need("type", expected_type));
}

std::vector<At> fields_of(const At& array) {
  if (!array.is(Value::Type::array)) {
    array.refuse("an array of fields");
  }
  return array.children();
}

void check_end(const At& at, const Layout& layout) {
  if (layout.bytes() > max_data_length) {
    at.wrong("ends with byte " + std::to_string(layout.bytes()) +
             "; expected 8 at most in a message");
  }
}

}  // namespace

unsigned Layout::place(unsigned width) {
  const unsigned left = (8 - next_bit_ % 8) % 8;
  if (width > left) {
    next_bit_ += left;
  }
  const unsigned first = next_bit_;
  next_bit_ += width;
  return first;
}

unsigned Layout::bytes_left() const {
  return max_data_length - std::min<unsigned>(bytes(), max_data_length);
}

std::vector<Field> read_message_fields(const At& array, Layout& layout) {
  std::vector<Field> fields;
  for (const At& at : fields_of(array)) {
    if (!fields.empty() && fields.back().form == Field::Form::bytes) {
      at.wrong("follows " + quote(fields.back().name) +
               ", of type bytes; expected bytes as the last field");
    }
    const Object any(at, all_names());
    const TypeRule& rule = type_of(any);
    const Object object = object_of_type(any, rule);
    Field field = read_field(object, rule, layout.bytes_left());
    refuse_twin(object, fields, field.name);
    field.first_bit = static_cast<std::uint8_t>(layout.place(field.width));
    check_end(at, layout);
    fields.push_back(std::move(field));
  }
  return fields;
}

std::vector<Field> read_settings(const At& array) {
  std::vector<Field> fields;
  if (array.value().children.size() > max_settings) {
    array.wrong(std::to_string(array.value().children.size()) + " settings; expected at most " +
                std::to_string(max_settings));
  }
  for (const At& at : fields_of(array)) {
    const Object any(at, all_names());
    const TypeRule& rule = type_of(any);
    if (rule.form == Field::Form::bytes) {
      any.need("type", "").refuse("another type: a setting is a number or a choice");
    }
    const Object object = object_of_type(any, rule);
    Field field = read_field(object, rule, 0);
    refuse_twin(object, fields, field.name);
    fields.push_back(std::move(field));
  }
  return fields;
}

}  // namespace roio::robot_file
