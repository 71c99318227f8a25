/// The JSON of roio-cli's lines. In a build without roio::json (json_missing.cpp), each says so.
#ifndef ROIO_CLI_JSON_LINES_HPP
#define ROIO_CLI_JSON_LINES_HPP

#include <roio/json.hpp>
#include <string_view>

namespace roio::cli {

/// parse_json(), or an error that says that this build knows no JSON.
Parsed<JsonMessage> parse_json_line(std::string_view line);

}  // namespace roio::cli

#endif
