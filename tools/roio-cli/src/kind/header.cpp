#include "kind/header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kind/facts.hpp"
#include "kind/header_message.hpp"
#include "kind/names.hpp"

namespace roio::cli {
namespace {

using header::FieldNames;
using header::MessageNames;

/// A text for people as a line of comment. A backslash at the end, also as a trigraph, would go on
/// with the next line.
std::string comment(std::string_view mark, const std::string& text) {
  const std::string line = one_line(text);
  const bool goes_on = line.ends_with('\\') || line.ends_with("?\?/");
  return line.empty() ? "" : fmt::format("{} {}{}\n", mark, line, goes_on ? " ." : "");
}

/// "0 to 180 deg"; where one on the wire is not one of the unit, "0 to 200, each 1/2 deg".
std::string what_it_holds(const Field& field) {
  std::string text = range_of(field);
  if (field.scale.numerator != field.scale.denominator) {
    text = fmt::format("{} to {}, each {}{}{}", field.minimum, field.maximum,
                       to_string(field.scale), field.unit.empty() ? "" : " ", field.unit);
  }
  return field.description.empty() ? text : text + ": " + field.description;
}

std::string choice_enum(const FieldNames& names) {
  std::string text = fmt::format("enum class {} : uint8_t {{\n", names.choice_type);
  for (std::size_t i = 0; i < names.choices.size(); ++i) {
    text += fmt::format("  {} = {},\n", names.choices[i], names.field->choices[i].raw);
  }
  const std::string check = header::choice_check(names);
  return text + fmt::format("}};\nconstexpr bool is_valid({}{}) {{\n  return {};\n}}\n\n",
                            names.choice_type, check == header::always ? "" : " value", check);
}

struct Member {
  std::string declaration;  ///< "uint8_t shoulder;"
  std::string what;
};

std::vector<Member> members_of(const MessageNames& names) {
  std::vector<Member> members;
  for (const FieldNames& field : names.fields) {
    const std::string type = header::type_of(field);
    if (field.field->form != Field::Form::bytes) {
      members.push_back({fmt::format("{} {};", type, field.member), what_it_holds(*field.field)});
    } else {
      members.push_back({fmt::format("{} {}[{}];", type, field.member, field.field->maximum),
                         what_it_holds(*field.field)});
    }
    if (!field.count_member.empty()) {
      members.push_back({fmt::format("uint8_t {};", field.count_member), "How many of them."});
    }
  }
  return members;
}

std::string message_struct(const MessageNames& names) {
  const std::vector<Member> members = members_of(names);
  std::string text = comment("///", names.message->description);
  if (members.empty()) {
    return text + fmt::format("struct {} {{}};\n", names.type);
  }
  std::size_t width = 0;
  for (const Member& member : members) {
    width = std::max(width, member.declaration.size());
  }
  text += fmt::format("struct {} {{\n", names.type);
  for (const Member& member : members) {
    text += fmt::format("  {:<{}}{}", member.declaration, width, comment("  ///<", member.what));
  }
  return text + "};\n";
}

std::string field_facts(const FieldNames& names) {
  const Field& field = *names.field;
  if (field.form == Field::Form::choice) {
    return "";
  }
  const bool is_signed = field.form == Field::Form::signed_number;
  std::string text =
      fmt::format("namespace {} {{\nconstexpr {} minimum = {}, maximum = {};\n", names.member,
                  header::type_of(names), header::literal(field.minimum, is_signed),
                  header::literal(field.maximum, is_signed));
  if (field.form != Field::Form::bytes) {
    text += fmt::format("constexpr uint32_t numerator = {}, denominator = {};\n",
                        header::literal(field.scale.numerator, false),
                        header::literal(field.scale.denominator, false));
  }
  return text + fmt::format("}}  // namespace {}\n", names.member);
}

std::string message_facts(const MessageNames& names) {
  const MessageKind& message = *names.message;
  std::string text = fmt::format("namespace {} {{\nconstexpr uint8_t length = {};\n", names.facts,
                                 message.max_length);
  if (message.min_length != message.max_length) {
    text += fmt::format("constexpr uint8_t minimum_length = {};\n", message.min_length);
  }
  if (message.tag) {
    text += fmt::format("constexpr uint8_t tag = {};\n", *message.tag);
  }
  for (const FieldNames& field : names.fields) {
    text += field_facts(field);
  }
  return text + fmt::format("}}  // namespace {}\n", names.facts);
}

std::string length_function(const MessageNames& names) {
  const std::string& count = names.fields.empty() ? "" : names.fields.back().count_member;
  if (count.empty()) {
    return fmt::format("constexpr uint8_t length_of(const {}&) {{\n  return {};\n}}\n", names.type,
                       names.message->max_length);
  }
  const std::int64_t before = names.message->max_length - names.fields.back().field->maximum;
  return fmt::format(
      "constexpr uint8_t length_of(const {}& message) {{\n  return {};\n}}\n", names.type,
      before == 0 ? "message." + count
                  : fmt::format("static_cast<uint8_t>({} + message.{})", before, count));
}

std::string message_text(const MessageKind& message, Scope& scope) {
  const MessageNames names = header::names_of(message, scope);
  std::string text =
      fmt::format("// --- {}: {}{}\n\n", message.name, length_of(message),
                  message.tag ? fmt::format(", the first of them {}", *message.tag) : "");
  for (const FieldNames& field : names.fields) {
    text += field.choice_type.empty() ? "" : choice_enum(field);
  }
  text += message_struct(names) + '\n' + message_facts(names) + '\n';
  text += length_function(names) + header::pack_function(names) + header::unpack_function(names);
  text += fmt::format(
      "template <typename AnyMessage>\n"
      "bool unpack(const AnyMessage& message, {}& to) {{\n"
      "  return unpack(message.data(), message.length(), to);\n"
      "}}\n\n",
      names.type);
  return text;
}

std::string direction(const char* name, const char* what,
                      const std::vector<MessageKind>& messages) {
  if (messages.empty()) {
    return "";
  }
  std::string text = fmt::format("// {}\nnamespace {} {{\n\n", what, name);
  Scope scope = header::direction_scope();
  for (const MessageKind& message : messages) {
    text += message_text(message, scope);
  }
  return text + fmt::format("}}  // namespace {}\n\n", name);
}

constexpr const char* manual = R"(//
// A message is a struct of what is on the wire, and there are, for each:
//
//   bool pack(const Message& from, uint8_t* bytes)
//     writes length_of(from) bytes, NAME::length of them at most. False when a value is out of
//     range: then it writes none.
//   bool unpack(const uint8_t* bytes, uint8_t length, Message& to)
//   bool unpack(const Roio::Message& message, Message& to)
//     False when length or tag are another message's, or a value is out of range: then `to` stays
//     as it is.
//   NAME::length, NAME::tag, NAME::FIELD::minimum and maximum: on the wire. A value in its unit is
//     what is on the wire, times NAME::FIELD::numerator, divided by NAME::FIELD::denominator.
//
// No heap, no floats, nothing but <stdint.h>.
)";

}  // namespace

std::string kind_header(const Kind& kind, std::string_view source) {
  const std::string space = global_identifier(kind.name);
  std::string guard = "ROIO_KIND_" + identifier(kind.name) + "_H";
  for (char& c : guard) {
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  std::string text = fmt::format("// {}\n//\n", origin("kind header", source));
  text += comment("//", kind.description.empty() ? kind.name : kind.name + ": " + kind.description);
  text += manual;
  text += fmt::format("#ifndef {0}\n#define {0}\n\n#include <stdint.h>\n\nnamespace {1} {{\n\n",
                      guard, space);
  text += direction("heard", "What such a board understands.", kind.heard);
  text += direction("said", "What such a board sends.", kind.said);
  return text + fmt::format("}}  // namespace {}\n\n#endif\n", space);
}

}  // namespace roio::cli
