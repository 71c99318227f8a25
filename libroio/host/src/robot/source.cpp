#include "robot/source.hpp"

#include <algorithm>

#include "robot/limits.hpp"
#include "text/utf8.hpp"

namespace roio::robot_file {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::size_t longest_name = 400;

bool is_control(char character) {
  return (character >= '\0' && character < ' ') || character == '\x7F';
}

}  // namespace

std::string shown_name(std::string_view file) {
  const bool is_plain = find_not_utf8(file) == file.size() && file.size() <= longest_name &&
                        std::none_of(file.begin(), file.end(), is_control);
  return is_plain ? std::string(file) : quote(file);
}

ParseError Source::error(std::size_t offset, std::string_view place,
                         const std::string& what) const {
  offset = std::min(offset, text_.size());
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(offset), '\n');
  std::string message = shown_name(origin_) + ':' + std::to_string(line) + ": ";
  if (!place.empty()) {
    message += std::string(place) + ": ";
  }
  return {message + what, offset};
}

void Source::refuse(const std::string& what) const {
  throw Refused({shown_name(origin_) + ": " + what, 0});
}

void check_text(const Source& source) {
  const std::string_view text = source.text();
  if (text.size() > max_text) {
    source.refuse(std::to_string(text.size()) + " bytes; expected at most " +
                  std::to_string(max_text));
  }
  const std::size_t not_utf8 = find_not_utf8(text);
  if (not_utf8 < text.size()) {
    source.refuse(not_utf8, "", quote(text.substr(not_utf8, 1)) + " is not UTF-8");
  }
  // To the parser, a zero byte is the end of the text, and the mark is nothing.
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    source.refuse(zero, "", "a zero byte; expected text");
  }
  if (text.starts_with(byte_order_mark)) {
    source.refuse(0, "", "a byte order mark; expected none");
  }
}

}  // namespace roio::robot_file
