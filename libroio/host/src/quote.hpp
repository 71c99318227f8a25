#ifndef ROIO_QUOTE_HPP
#define ROIO_QUOTE_HPP

#include <roio/text.hpp>
#include <string>
#include <string_view>

namespace roio {

/// Puts what was being read in front of an error: `address "0.300": ` and the message.
ParseError in_context(const char* what, std::string_view text, ParseError error);

}  // namespace roio

#endif
