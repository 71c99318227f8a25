/// A kind as an ES module for browsers and Node.js.
#ifndef ROIO_CLI_KIND_JS_HPP
#define ROIO_CLI_KIND_JS_HPP

#include <roio/kind.hpp>
#include <string>
#include <string_view>

namespace roio::cli {

/// Exports `heard` and `said`: by a message's name its pack() and unpack(), which round and refuse
/// as roio::pack() does. Types are JSDoc's. It imports nothing.
/// @param source the kind's file, for the first line.
std::string kind_js(const Kind& kind, std::string_view source);

/// A text as JavaScript, and JSON, write it.
std::string js_string(std::string_view text);

}  // namespace roio::cli

#endif
