#include "kind/commands.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {
namespace {

[[noreturn]] void refuse_files() {
  throw UsageError(
      "this roio-cli was built without JSON (ROIO_BUILD_JSON), as which the files are written");
}

}  // namespace

int make_from_kind(const KindOptions& /*options*/) {
  refuse_files();
}

int make_dbc(const RobotDbcOptions& /*options*/) {
  refuse_files();
}

int check_robot(const RobotCheckOptions& /*options*/) {
  refuse_files();
}

}  // namespace roio::cli
