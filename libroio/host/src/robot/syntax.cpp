#include "robot/syntax.hpp"

#include <algorithm>
#include <string>

#include "text/decimal.hpp"

namespace roio::robot_file {
namespace {

constexpr std::string_view blanks = " \t\r\n";

bool is_of_a_word(char character) {
  return is_digit(character) || (character >= 'a' && character <= 'z') ||
         (character >= 'A' && character <= 'Z') || character == '-' || character == '+' ||
         character == '.';
}

bool is_escaped(std::string_view text, std::size_t at) {
  std::size_t backslashes = 0;
  while (backslashes < at && text[at - 1 - backslashes] == '\\') {
    ++backslashes;
  }
  return backslashes % 2 == 1;
}

bool is_control(char character) {
  return character >= '\0' && character < ' ';
}

/// The parser stops behind a text that does not belong where it is, at its last quote.
std::size_t start_of_text(std::string_view text, std::size_t fault) {
  std::size_t at = fault;
  while (at > 0) {
    --at;
    if (text[at] == '"' && !is_escaped(text, at)) {
      return at;
    }
  }
  return fault;
}

/// And within a word that is none: at "ope" of "nope", which begins as null does.
std::size_t start_of_word(std::string_view text, std::size_t fault) {
  while (fault > 0 && is_of_a_word(text[fault - 1])) {
    --fault;
  }
  return fault;
}

std::size_t start_of_fault(std::string_view text, std::size_t fault) {
  if (text[fault] == '"') {
    return start_of_text(text, fault);
  }
  if (is_control(text[fault])) {
    return fault;
  }
  const bool is_escape = fault > 0 && text[fault - 1] == '\\';
  return is_escape ? fault - 1 : start_of_word(text, fault);
}

/// The end of the document that is whole; the parser reads on behind it to the next fault.
std::size_t end_of_document(std::string_view text) {
  bool in_text = false;
  std::size_t depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char character = text[at];
    if (in_text && character == '\\') {
      ++at;
    } else if (character == '"') {
      in_text = !in_text;
    } else if (!in_text && (character == '{' || character == '[')) {
      ++depth;
    } else if (!in_text && (character == '}' || character == ']') && --depth == 0) {
      return at + 1;
    }
  }
  return text.size();
}

/// By what stands before it.
std::string expected_after(char before, const SyntaxState& state) {
  const bool in_object = state.open == Value::Type::object;
  switch (before) {
    case ',':
      return in_object ? "a name in double quotes" : "a value";
    case '{':
      return "a name in double quotes, or }";
    case '[':
      return "a value, or ]";
    case ':':
      return "a value";
    default:
      break;
  }
  if (state.needs_colon) {
    return "a colon";
  }
  return in_object ? "a comma or }" : "a comma or ]";
}

std::string expected_at(std::string_view text, std::size_t fault, const SyntaxState& state) {
  if (text[fault] == '/') {
    return "no comment: JSON has none";
  }
  if (is_control(text[fault])) {
    return "the end of the text, which is on one line";
  }
  const std::size_t before = text.substr(0, fault).find_last_not_of(blanks);
  if (text[fault] == '\\') {
    return "an escape of JSON, such as \\n or \\\\";
  }
  if (!state.open || before == std::string_view::npos) {
    return "an object";
  }
  return expected_after(text[before], state);
}

/// What is in the way, to the end of its line.
std::string shown(std::string_view text, std::size_t fault) {
  const std::string_view rest = text.substr(fault);
  return quote(rest.substr(0, std::max<std::size_t>(1, rest.find_first_of("\r\n"))));
}

}  // namespace

void refuse_syntax(const Source& source, std::size_t fault, std::string_view place,
                   const SyntaxState& state) {
  const std::string_view text = source.text();
  if (state.is_complete) {
    const std::size_t rest = text.find_first_not_of(blanks, end_of_document(text));
    fault = rest == std::string_view::npos ? fault : rest;
    source.refuse(fault, "", shown(text, fault) + " behind the end; expected nothing more");
  }
  if (fault >= text.size()) {
    source.refuse(text.size(), place,
                  "the text ends here; expected " + std::string(state.open ? "more" : "an object"));
  }
  fault = start_of_fault(text, fault);
  source.refuse(fault, place, shown(text, fault) + "; expected " + expected_at(text, fault, state));
}

}  // namespace roio::robot_file
