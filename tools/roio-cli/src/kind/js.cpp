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

// The part that all kinds have alike. It is checked by TypeScript, too: `tsc --checkJs --strict`.
constexpr const char* runtime = R"(/**
 * A field: minimum and maximum are on the wire, of bytes their number.
 * @typedef {{
 *   name: string, form: "number" | "signed" | "choice" | "bytes", bit: number, width: number,
 *   minimum: number, maximum: number, unit?: string, scale?: number[], choices?: Record<string, number>
 * }} Field
 */

/** @param {Field} field  @param {number} raw */
function inUnit(field, raw) {
  const [numerator, denominator] = field.scale ?? [1, 1];
  return (raw * numerator) / denominator;
}

/** @param {Field} field */
function expected(field) {
  if (field.form === "choice") {
    return `one of ${Object.keys(field.choices ?? {}).join(", ")}`;
  }
  if (field.form === "bytes") {
    return `a Uint8Array of ${field.minimum} to ${field.maximum}`;
  }
  const unit = field.unit ? ` ${field.unit}` : "";
  return `a number ${inUnit(field, field.minimum)}..${inUnit(field, field.maximum)}${unit}`;
}

/**
 * What goes on the wire, of bytes their number; not a number: the value is none of the field's.
 * @param {Field} field  @param {unknown} value
 */
function rawOf(field, value) {
  let raw = NaN;
  if (field.form === "choice") {
    return typeof value === "string" && Object.hasOwn(field.choices ?? {}, value) ? field.choices?.[value] ?? NaN : NaN;
  }
  if (field.form === "bytes") {
    raw = value instanceof Uint8Array ? value.length : NaN;
  } else if (typeof value === "number") {
    const [numerator, denominator] = field.scale ?? [1, 1];
    const steps = (value * denominator) / numerator;
    raw = Math.sign(steps) * Math.round(Math.abs(steps));
  }
  return raw >= field.minimum && raw <= field.maximum ? raw : NaN;
}

/** @param {Uint8Array} bytes  @param {Field} field  @param {number} raw */
function put(bytes, field, raw) {
  for (let i = 0; i < field.width; ++i) {
    const bit = field.bit + field.width - 1 - i;
    bytes[bit >> 3] |= (Math.floor(raw / 2 ** i) & 1) << (7 - (bit & 7));
  }
}

/** @param {Uint8Array} bytes  @param {Field} field */
function get(bytes, field) {
  let raw = 0;
  for (let bit = field.bit; bit < field.bit + field.width; ++bit) {
    raw = raw * 2 + ((bytes[bit >> 3] >> (7 - (bit & 7))) & 1);
  }
  return field.form === "signed" && raw >= 2 ** (field.width - 1) ? raw - 2 ** field.width : raw;
}

/** @param {Uint8Array} bytes  @param {Field} field */
function valueOf(bytes, field) {
  if (field.form === "bytes") {
    return bytes.slice(field.bit >> 3);
  }
  const raw = get(bytes, field);
  if (field.form === "choice") {
    return Object.entries(field.choices ?? {}).find(([, number]) => number === raw)?.[0] ?? raw;
  }
  return inUnit(field, raw);
}

/** @template {object} Values */
class Message {
  /**
   * @param {string} name  @param {number | null} tag  @param {number} minimumLength
   * @param {number} length  @param {Field[]} fields
   */
  constructor(name, tag, minimumLength, length, fields) {
    this.name = name;
    this.tag = tag;
    this.minimumLength = minimumLength;
    this.length = length;
    this.fields = fields;
  }

  /** @param {Values} values  @returns {string | null} */
  problem(values) {
    const given = new Map(Object.entries(values));
    const unknown = [...given.keys()].find((name) => !this.fields.some((field) => field.name === name));
    if (unknown !== undefined) {
      const names = this.fields.map((field) => field.name).join(", ") || "none";
      return `${this.name}: no field ${JSON.stringify(unknown)}; expected ${names}`;
    }
    for (const field of this.fields) {
      const value = given.get(field.name);
      if (value === undefined) {
        if (field.form !== "bytes" || field.minimum > 0) {
          return `${this.name}.${field.name}: missing; expected ${expected(field)}`;
        }
      } else if (Number.isNaN(rawOf(field, value))) {
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
    const given = new Map(Object.entries(values));
    const bytes = new Uint8Array(this.length);
    let length = this.length;
    if (this.tag !== null) {
      bytes[0] = this.tag;
    }
    for (const field of this.fields) {
      if (field.form === "bytes") {
        const rest = given.get(field.name) ?? new Uint8Array(0);
        bytes.set(rest, field.bit >> 3);
        length = (field.bit >> 3) + rest.length;
      } else {
        put(bytes, field, rawOf(field, given.get(field.name)));
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
    return /** @type {Values} */ (
      Object.fromEntries(this.fields.map((field) => [field.name, valueOf(bytes, field)])));
  }
}

/**
 * The message of a direction that fits what came.
 * @param {typeof heard | typeof said} direction
 * @param {Uint8Array} bytes
 * @returns {{name: string, values: object} | null}
 */
export function unpack(direction, bytes) {
  for (const message of Object.values(direction)) {
    const values = message.unpack(bytes);
    if (values !== null) {
      return {name: message.name, values};
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
