#ifndef ROIO_QUOTE_HPP
#define ROIO_QUOTE_HPP

#include <roio/text.hpp>
#include <string>
#include <string_view>

namespace roio {

/// A text of any origin made fit for one line of an error message: in double quotes, with control
/// characters and bytes that are no UTF-8 as \xNN (\n, \r, \t, \", \\ as in C), and cut off after
/// about 48 bytes, saying how long it was.
std::string quote(std::string_view text);

/// Puts what was being read in front of an error: `address "0.300": ` and the message.
ParseError in_context(const char* what, std::string_view text, ParseError error);

}  // namespace roio

#endif
