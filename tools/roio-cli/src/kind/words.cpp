#include "kind/words.hpp"

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* kind_examples = R"(Examples:
  roio-cli kind header -o servo_arm.h servo-arm.kind.json   for a sketch
  roio-cli kind js -o servo-arm.js servo-arm.kind.json      for a page
  roio-cli kind md servo-arm.kind.json                      for people
  roio-cli kind header --check -o servo_arm.h servo-arm.kind.json

FILE says what a kind of board hears and says. --check writes nothing, and
exits with 1 when OUT is not what FILE makes.
More: man roio-cli-kind, roio-cli kind header --help)";

constexpr const char* header_examples = R"(Examples:
  roio-cli kind header -o servo_arm.h servo-arm.kind.json
  roio-cli kind header --check -o servo_arm.h servo-arm.kind.json

In a sketch:
  servo_arm::heard::Angles angles;
  if (unpack(message, angles)) {  // the right length, every value in range
    arm.write(angles.shoulder);
  }
C++11 without its library, without floats and heap; for a PC, too.)";

constexpr const char* js_examples = R"(Examples:
  roio-cli kind js -o servo-arm.js servo-arm.kind.json

In a page, or in Node.js:
  import {heard} from "./servo-arm.js";
  const bytes = heard.angles.pack({shoulder: 90, elbow: 45, hand: 0});
An ES module that imports nothing, with types as JSDoc has them.)";

constexpr const char* md_examples = R"(Examples:
  roio-cli kind md servo-arm.kind.json
  roio-cli kind md -o servo-arm.md servo-arm.kind.json

Markdown: a table of the bytes of each message.)";

constexpr const char* robot_examples = R"(Examples:
  roio-cli robot check robot.json
  roio-cli robot dbc -o robot.dbc robot.json

FILE says which boards a robot has, and where.
More: man roio-cli-robot, roio-cli robot dbc --help)";

constexpr const char* dbc_examples = R"(Examples:
  roio-cli robot dbc -o robot.dbc robot.json     for SavvyCAN, cantools
  roio-cli robot dbc --check -o robot.dbc robot.json

A message for each place that sends and each that receives, or everybody of a
subnet, where their kinds have names; signals are called MESSAGE_FIELD. Messages
that are told apart by length alone have no signals: a DBC cannot do that. They
are told on standard error. Urgent messages have identifiers of their own, and
are not in it.)";

constexpr const char* check_examples = R"(Examples:
  roio-cli robot check robot.json

Prints the places, and what their kinds hear and say; or the first error of the
robot's file or of a kind's, with file, line and what was expected: exit 1.)";

constexpr const char* kind_commands = "header, js or md";
constexpr const char* robot_commands = "dbc or check";

const std::string& file_of(const CLI::App& app, const std::string& command, const std::string& file,
                           const char* example) {
  refuse_rest(app, command);
  if (file.empty()) {
    refuse(command, std::string("expected FILE, such as ") + example);
  }
  return file;
}

constexpr const char* kind_file = "servo-arm.kind.json";
constexpr const char* robot_file = "robot.json";

}  // namespace

void TargetWords::declare(CLI::App& app) {
  option(app, "-o,--output", output_, "OUT", "Write to this file (none: standard output)");
  flag(app, "--check", "Write nothing; exit 1 when OUT is stale");
}

Target TargetWords::parse(const CLI::App& app) const {
  Target target;
  const bool has_output = app.count("--output") > 0;
  if (has_output && output_.empty()) {
    throw UsageError("-o: expected the name of a file, found \"\"");
  }
  if (has_output) {
    target.file = output_;
  }
  target.check = app.count("--check") > 0;
  if (target.check && !has_output) {
    throw UsageError("--check: expected with -o OUT, the file to look at");
  }
  return target;
}

KindWords::KindWords(CLI::App& program)
    : app_(program.add_subcommand("kind", "Make code and pages from a kind's messages")),
      header_(
          &declare("header", "Make a C++11 header", "kind header [OPTIONS] FILE", header_examples)),
      js_(&declare("js", "Make an ES module", "kind js [OPTIONS] FILE", js_examples)),
      md_(&declare("md", "Make a page for people", "kind md [OPTIONS] FILE", md_examples)) {
  prepare(*app_, "kind header|js|md [OPTIONS] FILE", kind_examples);
  app_->require_subcommand(0, 1);
}

CLI::App& KindWords::declare(const char* name, const char* description, const char* usage,
                             const char* examples) {
  CLI::App& app = *app_->add_subcommand(name, description);
  prepare(app, usage, examples);
  without_type(app.add_option("FILE", file_, kind_file));
  target_.declare(app);
  return app;
}

void KindWords::refuse_unknown() const {
  refuse_rest(*app_, "kind", kind_commands);
}

Command KindWords::parse() const {
  using Language = KindOptions::Language;
  for (const auto& [app, language] :
       {std::pair(header_, Language::header), {js_, Language::js}, {md_, Language::md}}) {
    if (app->parsed()) {
      const std::string& file = file_of(*app, "kind " + app->get_name(), file_, kind_file);
      return KindOptions{language, file, target_.parse(*app)};
    }
  }
  refuse_unknown();
  refuse("kind", std::string("expected a command: ") + kind_commands);
}

RobotWords::RobotWords(CLI::App& program)
    : app_(program.add_subcommand("robot", "Look at a robot's file, and make a DBC from it")),
      dbc_(app_->add_subcommand("dbc", "Make a DBC file")),
      check_(app_->add_subcommand("check", "Print what a robot has")) {
  prepare(*app_, "robot dbc|check [OPTIONS] FILE", robot_examples);
  app_->require_subcommand(0, 1);
  prepare(*dbc_, "robot dbc [OPTIONS] FILE", dbc_examples);
  prepare(*check_, "robot check FILE", check_examples);
  without_type(dbc_->add_option("FILE", file_, robot_file));
  without_type(check_->add_option("FILE", file_, robot_file));
  target_.declare(*dbc_);
}

void RobotWords::refuse_unknown() const {
  refuse_rest(*app_, "robot", robot_commands);
}

Command RobotWords::parse() const {
  if (dbc_->parsed()) {
    const std::string& file = file_of(*dbc_, "robot dbc", file_, robot_file);
    return RobotDbcOptions{file, target_.parse(*dbc_)};
  }
  if (check_->parsed()) {
    return RobotCheckOptions{file_of(*check_, "robot check", file_, robot_file)};
  }
  refuse_unknown();
  refuse("robot", std::string("expected a command: ") + robot_commands);
}

}  // namespace roio::cli
