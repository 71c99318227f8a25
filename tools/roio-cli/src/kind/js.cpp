#include "kind/js.hpp"

#include <fmt/format.h>

#include "kind/facts.hpp"
#include "kind/names.hpp"

namespace roio::cli {
namespace {

constexpr const char* manual = R"(//
//   import {heard, said, unpack} from "./NAME.js";
//
//   heard.MESSAGE.pack({FIELD: value, ...})  its bytes, a Uint8Array; throws a RangeError that names
//                                            the field that is missing, unknown or out of range
//   heard.MESSAGE.unpack(bytes)              its values; null: length or tag are another message's
//   heard.MESSAGE.problem(values)            what pack() would throw, as a text; null: nothing
//   unpack(said, bytes)                      {name, values} of the message that fits; null: none
//
// Numbers are in the field's unit, rounded to its nearest step, halves away from zero; choices are
// their names. A board can send what is out of range: it is shown as it is, and a choice that has no
// name is its number.

)";

// The part that all kinds have alike. Fields: name, form, first bit, width, smallest and largest
// number on the wire; then of numbers the unit and the scale, of choices name by number.
constexpr const char* runtime = R"(function expected(field) {
  if (field.form === "choice") {
    return `one of ${Object.keys(field.choices).join(", ")}`;
  }
  if (field.form === "bytes") {
    return `${field.minimum} to ${field.maximum} bytes`;
  }
  const [numerator, denominator] = field.scale;
  const unit = field.unit ? ` ${field.unit}` : "";
  return `a number ${(field.minimum * numerator) / denominator}..${(field.maximum * numerator) / denominator}${unit}`;
}

/** What goes on the wire; undefined: the value is none of the field's. */
function rawOf(field, value) {
  if (field.form === "choice") {
    return typeof value === "string" && Object.hasOwn(field.choices, value) ? field.choices[value] : undefined;
  }
  let raw;
  if (field.form === "bytes") {
    raw = value instanceof Uint8Array ? value.length : NaN;
  } else if (typeof value === "number") {
    const steps = (value * field.scale[1]) / field.scale[0];
    raw = Math.sign(steps) * Math.round(Math.abs(steps));
  }
  return raw >= field.minimum && raw <= field.maximum ? raw : undefined;
}

function put(bytes, field, raw) {
  for (let i = 0; i < field.width; ++i) {
    const bit = field.bit + field.width - 1 - i;
    bytes[bit >> 3] |= (Math.floor(raw / 2 ** i) & 1) << (7 - (bit & 7));
  }
}

function get(bytes, field) {
  let raw = 0;
  for (let bit = field.bit; bit < field.bit + field.width; ++bit) {
    raw = raw * 2 + ((bytes[bit >> 3] >> (7 - (bit & 7))) & 1);
  }
  return field.form === "signed" && raw >= 2 ** (field.width - 1) ? raw - 2 ** field.width : raw;
}

function valueOf(field, bytes) {
  if (field.form === "bytes") {
    return bytes.slice(field.bit >> 3);
  }
  const raw = get(bytes, field);
  if (field.form === "choice") {
    return Object.keys(field.choices).find((name) => field.choices[name] === raw) ?? raw;
  }
  return (raw * field.scale[0]) / field.scale[1];
}

/** @template Values */
class Message {
  constructor(name, tag, minimumLength, length, fields) {
    Object.assign(this, {name, tag, minimumLength, length, fields});
  }

  /** @param {Values} values  @returns {string | null} */
  problem(values) {
    const unknown = Object.keys(values).find((name) => !this.fields.some((field) => field.name === name));
    if (unknown !== undefined) {
      const names = this.fields.map((field) => field.name).join(", ") || "none";
      return `${this.name}: no field ${JSON.stringify(unknown)}; expected ${names}`;
    }
    for (const field of this.fields) {
      if (!Object.hasOwn(values, field.name)) {
        if (field.form !== "bytes" || field.minimum > 0) {
          return `${this.name}.${field.name}: missing; expected ${expected(field)}`;
        }
      } else if (rawOf(field, values[field.name]) === undefined) {
        const value = values[field.name];
        const shown = typeof value === "string" ? JSON.stringify(value) : String(value);
        return `${this.name}.${field.name}: ${shown}; expected ${expected(field)}`;
      }
    }
    return null;
  }

  /** @param {Values} values  @returns {Uint8Array} */
  pack(values) {
    const problem = this.problem(values);
    if (problem !== null) {
      throw new RangeError(problem);
    }
    const bytes = new Uint8Array(this.length);
    let length = this.length;
    if (this.tag !== null) {
      bytes[0] = this.tag;
    }
    for (const field of this.fields) {
      if (field.form === "bytes") {
        const rest = Object.hasOwn(values, field.name) ? values[field.name] : new Uint8Array(0);
        bytes.set(rest, field.bit >> 3);
        length = (field.bit >> 3) + rest.length;
      } else {
        put(bytes, field, rawOf(field, values[field.name]));
      }
    }
    return bytes.slice(0, length);
  }

  /** @param {Uint8Array} bytes  @returns {Values | null} */
  unpack(bytes) {
    if (bytes.length < this.minimumLength || bytes.length > this.length ||
        (this.tag !== null && bytes[0] !== this.tag)) {
      return null;
    }
    return Object.fromEntries(this.fields.map((field) => [field.name, valueOf(field, bytes)]));
  }
}

/**
 * The message of a direction that fits what came.
 * @param {typeof heard | typeof said} direction
 * @param {Uint8Array} bytes
 * @returns {{name: string, values: object} | null}
 */
export function unpack(direction, bytes) {
  for (const [name, message] of Object.entries(direction)) {
    const values = message.unpack(bytes);
    if (values !== null) {
      return {name, values};
    }
  }
  return null;
}
)";

/// In a comment of the form that ends with the two characters left out here.
std::string in_comment(std::string_view text) {
  std::string line = one_line(text);
  for (std::size_t at = line.find("*/"); at != std::string::npos; at = line.find("*/", at)) {
    line.insert(at + 1, " ");
  }
  return line;
}

const char* form_of(const Field& field) {
  switch (field.form) {
    case Field::Form::signed_number:
      return "signed";
    case Field::Form::choice:
      return "choice";
    case Field::Form::bytes:
      return "bytes";
    case Field::Form::number:
      break;
  }
  return "number";
}

std::string field_entry(const Field& field) {
  std::string text =
      fmt::format("{{name: {}, form: \"{}\", bit: {}, width: {}, minimum: {}, maximum: {}",
                  js_string(field.name), form_of(field), field.first_bit, field.width,
                  field.minimum, field.maximum);
  if (field.form == Field::Form::choice) {
    std::string choices;
    for (const Choice& choice : field.choices) {
      choices +=
          fmt::format("{}{}: {}", choices.empty() ? "" : ", ", js_string(choice.name), choice.raw);
    }
    text += fmt::format(", choices: {{{}}}", choices);
  } else if (field.form != Field::Form::bytes) {
    text += fmt::format(", unit: {}, scale: [{}, {}]", js_string(field.unit), field.scale.numerator,
                        field.scale.denominator);
  }
  return text + "}";
}

std::string js_type(const Field& field) {
  if (field.form == Field::Form::bytes) {
    return "Uint8Array";
  }
  if (field.form != Field::Form::choice) {
    return "number";
  }
  std::string type;
  for (const Choice& choice : field.choices) {
    type += (type.empty() ? "" : " | ") + js_string(choice.name);
  }
  return type;
}

/// The values of a message as a type of JSDoc, with a name of its own.
std::string values_type(const MessageKind& message, const std::string& name) {
  std::string type;
  std::string text = fmt::format(
      "/**\n * {}\n", in_comment(message.description.empty() ? message.name : message.description));
  for (const Field& field : message.fields) {
    const bool may_miss = field.form == Field::Form::bytes && field.minimum == 0;
    type += fmt::format("{}{}{}: {}", type.empty() ? "" : ", ", js_string(field.name),
                        may_miss ? "?" : "", js_type(field));
    text += fmt::format(" * - {}: {}{}{}\n", field.name, in_comment(range_of(field)),
                        field.description.empty() ? "" : ": ", in_comment(field.description));
  }
  return text + fmt::format(" * @typedef {{{{{}}}}} {}\n */\n", type, name);
}

std::string message_entry(const MessageKind& message, const std::string& type) {
  std::string text = fmt::format(
      "  /** @type {{Message<{}>}} */\n  {}: new Message({}, {}, {}, {}, [", type,
      js_string(message.name), js_string(message.name),
      message.tag ? std::to_string(*message.tag) : "null", message.min_length, message.max_length);
  for (const Field& field : message.fields) {
    text += "\n    " + field_entry(field) + ',';
  }
  return text + (message.fields.empty() ? "]),\n" : "\n  ]),\n");
}

std::string direction(const char* name, const char* what, const std::vector<MessageKind>& messages,
                      Scope& types) {
  std::string text;
  std::string entries;
  for (const MessageKind& message : messages) {
    const std::string type = types.add(type_identifier(std::string(name) + '-' + message.name));
    text += values_type(message, type) + '\n';
    entries += message_entry(message, type);
  }
  return text + fmt::format("/** {} */\nexport const {} = {{\n{}}};\n\n", what, name, entries);
}

}  // namespace

std::string js_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string kind_js(const Kind& kind, std::string_view source) {
  std::string text = fmt::format("// {}\n//\n// {}{}{}\n", origin("kind js", source), kind.name,
                                 kind.description.empty() ? "" : ": ", one_line(kind.description));
  text += manual;
  text += runtime;
  text += '\n';
  Scope types{"Message"};
  text += direction("heard", "What such a board understands.", kind.heard, types);
  text += direction("said", "What such a board sends.", kind.said, types);
  text.pop_back();
  return text;
}

}  // namespace roio::cli
