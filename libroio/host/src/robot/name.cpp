#include "robot/name.hpp"

#include <algorithm>

#include "robot/limits.hpp"
#include "text/decimal.hpp"
#include "text/utf8.hpp"

namespace roio::robot_file {
namespace {

bool is_letter(char character) {
  return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z');
}

bool is_of_a_name(char character) {
  return is_letter(character) || is_digit(character) || character == '-' || character == '_';
}

/// U+0000..U+001F, U+007F..U+009F, and the two that end a line: U+2028, U+2029.
bool is_control(std::string_view character) {
  if (character.size() == 1) {
    return static_cast<unsigned char>(character[0]) < ' ' || character[0] == '\x7F';
  }
  return (character[0] == '\xC2' && static_cast<unsigned char>(character[1]) < 0xA0) ||
         character == "\xE2\x80\xA8" || character == "\xE2\x80\xA9";
}

}  // namespace

bool is_name(std::string_view text, FirstCharacter first) noexcept {
  if (text.empty() || text.size() > max_name) {
    return false;
  }
  const bool is_begun = first == FirstCharacter::any || is_letter(text[0]) ||
                        (first == FirstCharacter::letter_or_digit && is_digit(text[0]));
  return is_begun && std::all_of(text.begin(), text.end(), is_of_a_name);
}

bool is_line(std::string_view text, std::size_t min, std::size_t max) noexcept {
  std::size_t count = 0;
  while (!text.empty() && count <= max) {
    const std::size_t length = utf8_sequence_length(text);
    if (length == 0 || is_control(text.substr(0, length))) {
      return false;
    }
    text.remove_prefix(length);
    ++count;
  }
  return count >= min && count <= max;
}

}  // namespace roio::robot_file
