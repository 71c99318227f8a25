#include "bridge_report.hpp"
#include "exit_status.hpp"
#include "json_lines.hpp"
#include "record_format.hpp"

namespace roio::cli {
namespace {

constexpr const char* no_json = "this roio-cli was built without JSON (ROIO_BUILD_JSON)";

[[noreturn]] void refuse_json() {
  throw UsageError(std::string("--json: ") + no_json);
}

}  // namespace

Parsed<std::optional<Frame>> parse_json_line(std::string_view /*line*/,
                                             Address /*default_source*/) {
  return ParseError{no_json, 0};
}

std::unique_ptr<RecordFormat> json_format() {
  refuse_json();
}

void append_json(Buffer& /*out*/, const BridgeReport& /*report*/) {
  refuse_json();
}

void append_json(Buffer& /*out*/, const BusReport& /*report*/) {
  refuse_json();
}

}  // namespace roio::cli
