#include "kind/commands.hpp"

#include <string>

#include "kind/dbc.hpp"
#include "kind/header.hpp"
#include "kind/js.hpp"
#include "kind/md.hpp"
#include "kind/overview.hpp"
#include "names/robot.hpp"
#include "program/exit_status.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

template <typename T>
T value_or_fail(Parsed<T> parsed) {
  if (!parsed) {
    throw Failure(parsed.error().message);
  }
  return *parsed;
}

using Language = KindOptions::Language;

std::string made_from(const Kind& kind, const KindOptions& options) {
  const std::string source = options.file.string();
  switch (options.language) {
    case Language::js:
      return kind_js(kind, source);
    case Language::md:
      return kind_md(kind, source);
    case Language::header:
      break;
  }
  return kind_header(kind, source);
}

const char* name_of(Language language) {
  switch (language) {
    case Language::js:
      return "kind js";
    case Language::md:
      return "kind md";
    case Language::header:
      break;
  }
  return "kind header";
}

}  // namespace

int make_from_kind(const KindOptions& options) {
  const Kind kind = value_or_fail(load_kind(options.file));
  deliver(made_from(kind, options), options.target, options.file, name_of(options.language));
  return exit_success;
}

int make_dbc(const RobotDbcOptions& options) {
  const Robot robot = value_or_fail(load_robot(options.file, load_options()));
  if (robot.places.size() > most_dbc_places) {
    throw Failure(options.file.string() + ": " + std::to_string(robot.places.size()) +
                  " places; expected at most " + std::to_string(most_dbc_places) +
                  ", as a DBC has a message for each two of them");
  }
  const Dbc dbc = robot_dbc(robot, options.file.string());
  for (const std::string& text : dbc.notes) {
    note(options.file.string() + ": " + text);
  }
  deliver(dbc.text, options.target, options.file, "robot dbc");
  return exit_success;
}

int check_robot(const RobotCheckOptions& options) {
  const Robot robot = value_or_fail(load_robot(options.file, load_options()));
  deliver(overview(robot), {}, options.file, "");
  return exit_success;
}

}  // namespace roio::cli
