#ifndef ROIO_QUOTE_HPP
#define ROIO_QUOTE_HPP

#include <roio/text.hpp>
#include <string>
#include <string_view>

namespace roio {

/// Puts what was being read in front of an error: `address "0.300": ` and the message.
ParseError in_context(const char* what, std::string_view text, ParseError error);

/// The same, of what came out of reading: a value passes.
template <typename T>
Parsed<T> in_context(const char* what, std::string_view text, Parsed<T> parsed) {
  if (!parsed) {
    return in_context(what, text, parsed.error());
  }
  return parsed;
}

}  // namespace roio

#endif
