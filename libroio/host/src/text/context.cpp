#include "text/quote.hpp"

namespace roio {

ParseError in_context(const char* what, std::string_view text, ParseError error) {
  error.message = std::string(what) + ' ' + quote(text) + ": " + error.message;
  return error;
}

}  // namespace roio
