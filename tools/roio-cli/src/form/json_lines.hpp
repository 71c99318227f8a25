/// The JSON of roio-cli's lines. In a build without roio::json (json_missing.cpp), each says so.
#ifndef ROIO_CLI_JSON_LINES_HPP
#define ROIO_CLI_JSON_LINES_HPP

#include <optional>
#include <roio/address.hpp>
#include <roio/bus.hpp>
#include <roio/frame.hpp>
#include <roio/robot.hpp>
#include <roio/text.hpp>
#include <string>
#include <string_view>

namespace roio::cli {

struct JsonFrame {
  Frame frame;
  std::optional<Timestamp> time{};
  std::string bus{};  ///< That it comes from, where it says.
};

/// Reads what json_format() writes, and every message that parse_json() takes. Of a message that
/// names no source, it is `default_source`.
/// @param robot whose names a message may have; null: none.
/// @return the frame, and its time and bus where it has them; none: an error report, a loss or a
///         state, which cannot be sent; or what was expected, or that this build knows no JSON.
Parsed<std::optional<JsonFrame>> parse_json_line(std::string_view line, Address default_source,
                                                 const Robot* robot = nullptr);

}  // namespace roio::cli

#endif
