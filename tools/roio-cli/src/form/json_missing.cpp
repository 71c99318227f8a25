#include "bridge/report.hpp"
#include "form/json_lines.hpp"
#include "form/record_format.hpp"
#include "program/exit_status.hpp"
#include "top/lines.hpp"

namespace roio::cli {
namespace {

constexpr const char* no_json = "this roio-cli was built without JSON (ROIO_BUILD_JSON)";

[[noreturn]] void refuse_json() {
  throw UsageError(std::string("--json: ") + no_json);
}

}  // namespace

Parsed<std::optional<JsonFrame>> parse_json_line(std::string_view /*line*/,
                                                 Address /*default_source*/,
                                                 const Robot* /*robot*/) {
  return ParseError{no_json, 0};
}

std::unique_ptr<RecordFormat> json_format(bool /*with_bus*/,
                                          std::shared_ptr<const Robot> /*robot*/) {
  refuse_json();
}

void append_json(Buffer& /*out*/, const BridgeReport& /*report*/) {
  refuse_json();
}

void append_json(Buffer& /*out*/, const BusReport& /*report*/) {
  refuse_json();
}

void append_json(Buffer& /*out*/, const Snapshot& /*snapshot*/, const Robot* /*robot*/) {
  refuse_json();
}

}  // namespace roio::cli
