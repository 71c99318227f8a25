#include "kind/md.hpp"

#include <fmt/format.h>

#include "kind/facts.hpp"

namespace roio::cli {
namespace {

/// Text in a paragraph or a table: what Markdown would take for its own is marked.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : one_line(text)) {
    if (std::string_view("\\`*_{}[]<>#|").find(c) != std::string_view::npos) {
      result += '\\';
    }
    result += c;
  }
  return result;
}

/// "1", "2..3", and of a part of a byte "1, bits 7..5".
std::string place_of(const Field& field) {
  constexpr unsigned byte_bits = 8;
  const unsigned first = field.first_bit / byte_bits + 1;
  if (field.form == Field::Form::bytes) {
    return fmt::format("{}..", first);
  }
  if (field.width < byte_bits) {
    const unsigned highest = byte_bits - 1 - field.first_bit % byte_bits;
    return field.width == 1
               ? fmt::format("{}, bit {}", first, highest)
               : fmt::format("{}, bits {}..{}", first, highest, highest + 1 - field.width);
  }
  const unsigned last = first + field.width / byte_bits - 1;
  return first == last ? fmt::format("{}", first) : fmt::format("{}..{}", first, last);
}

std::string step_of(const Field& field) {
  const bool has_none = field.form == Field::Form::choice || field.form == Field::Form::bytes;
  return has_none ? "" : to_string(field.scale);
}

std::string row(const std::string& place, const Field& field) {
  return fmt::format("| {}{} | {} | {} | {} | {} |\n", place.empty() ? "" : place + " | ",
                     plain(field.name), type_of(field), plain(range_of(field)), step_of(field),
                     plain(field.description));
}

std::string message_text(const MessageKind& message) {
  std::string text = fmt::format("### {}\n\n", plain(message.name));
  text += message.description.empty() ? "" : plain(message.description) + "\n\n";
  text += length_of(message);
  text += message.tag ? fmt::format("; the first is {0} (0x{0:02X})", *message.tag) : "";
  text += ".\n\n";
  if (message.fields.empty()) {
    return text;
  }
  text += "| byte | field | type | range | step | |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const Field& field : message.fields) {
    text += row(place_of(field), field);
  }
  return text + '\n';
}

std::string direction(const char* title, const std::vector<MessageKind>& messages) {
  std::string text = messages.empty() ? "" : fmt::format("## {}\n\n", title);
  for (const MessageKind& message : messages) {
    text += message_text(message);
  }
  return text;
}

std::string settings(const std::vector<Field>& fields) {
  std::string text = fields.empty()
                         ? ""
                         : "## Settings\n\nSet for a place by the robot's file; on no wire.\n\n"
                           "| field | type | range | step | |\n| --- | --- | --- | --- | --- |\n";
  for (const Field& field : fields) {
    text += row("", field);
  }
  return text + (fields.empty() ? "" : "\n");
}

}  // namespace

std::string kind_md(const Kind& kind, std::string_view source) {
  std::string text =
      fmt::format("<!-- {} -->\n# {}\n\n", origin("kind md", source), plain(kind.name));
  text += kind.description.empty() ? "" : plain(kind.description) + "\n\n";
  text += "Bytes are counted from 1, bits from 7, the highest, to 0.\n\n";
  text +=
      direction("It hears", kind.heard) + direction("It says", kind.said) + settings(kind.settings);
  text.pop_back();
  return text;
}

}  // namespace roio::cli
