#ifndef ROIO_JSON_TEXT_HPP
#define ROIO_JSON_TEXT_HPP

#include <cstddef>
#include <optional>
#include <roio/text.hpp>
#include <string_view>

namespace roio {

/// What is wrong with a message's JSON before it is read as such: longer than `longest` bytes, not
/// UTF-8, with a zero byte or a byte order mark.
std::optional<ParseError> check_json_text(std::string_view text, std::size_t longest);

}  // namespace roio

#endif
