#include "text/json_text.hpp"

#include <string>

#include "text/utf8.hpp"

namespace roio {

std::optional<ParseError> check_json_text(std::string_view text, std::size_t longest) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.size() > longest) {
    return ParseError{"JSON: " + std::to_string(text.size()) + " bytes; expected at most " +
                          std::to_string(longest),
                      longest};
  }
  const std::size_t not_utf8 = find_not_utf8(text);
  if (not_utf8 < text.size()) {
    return ParseError{"JSON: not UTF-8 at byte " + std::to_string(not_utf8) + ", " +
                          quote(text.substr(not_utf8, 1)),
                      not_utf8};
  }
  // To the parser, a zero byte is the end of the text, and the mark is nothing.
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    return ParseError{"JSON: a zero byte at byte " + std::to_string(zero) + "; expected text",
                      zero};
  }
  if (text.starts_with(byte_order_mark)) {
    return ParseError{"JSON: begins with a byte order mark; expected none", 0};
  }
  return std::nullopt;
}

}  // namespace roio
