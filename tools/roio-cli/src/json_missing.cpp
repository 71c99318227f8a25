#include "exit_status.hpp"
#include "json_lines.hpp"
#include "record_format.hpp"

namespace roio::cli {
namespace {

constexpr const char* no_json = "this roio-cli was built without JSON (ROIO_BUILD_JSON)";

}  // namespace

Parsed<JsonMessage> parse_json_line(std::string_view /*line*/) {
  return ParseError{no_json, 0};
}

std::unique_ptr<RecordFormat> json_format() {
  throw UsageError(std::string("--json: ") + no_json);
}

}  // namespace roio::cli
