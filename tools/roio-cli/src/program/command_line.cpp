#include "program/command_line.hpp"

#include <CLI/CLI.hpp>
#include <optional>
#include <roio/version.hpp>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ask/words.hpp"
#include "attach/words.hpp"
#include "bridge/words.hpp"
#include "buses/hub_words.hpp"
#include "dump/words.hpp"
#include "gen/words.hpp"
#include "kind/words.hpp"
#include "program/words.hpp"
#include "record/play_words.hpp"
#include "record/record_words.hpp"
#include "send/words.hpp"
#include "top/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* main_examples = R"(Examples:
  roio-cli dump -n 1 local:robot &             one message, and end
  roio-cli send --wait local:robot 0.2 5A2D00  three bytes to node 2 of subnet 0
  roio-cli dump can0 to=0.2 urgent             urgent messages, on SocketCAN
  roio-cli ask can0 0.2 01                     a question, and its answer
  roio-cli dump serial:auto                    a bridge on a serial port
  roio-cli top can0                            who is there, live
  roio-cli record -o drive.log can0            until Ctrl-C; and back again:
  roio-cli play drive.log can0
  roio-cli gen --load 80% can0                 traffic, to try a bus
  roio-cli buses                               what there is to be opened
  roio-cli attach serial:/dev/ttyACM0 vcan0    two buses become one
  roio-cli robot check robot.json              what a robot has

BUS is a CAN interface (can0), serial:DEVICE, a bridge on a serial port, or
local:NAME, a bus between the programs of one user on this machine;
local:NAME?bitrate=500000 has the pace of a real one.
Exit status: 0 done, 1 failed, 2 not a right command line, 128+N by signal N.
More: man roio-cli, roio-cli help send, roio-cli help bridge set)";

constexpr const char* buses_examples = R"(Examples:
  roio-cli buses
  roio-cli buses --json | jq -r 'select(.kind == "serial").bus'

CAN interfaces, the local buses that some program is on, and bridges. To find
those it opens the serial ports that an Arduino may be at and no other program
has; that restarts most Arduinos. ROIO_SERIAL_PORTS=/dev/ttyUSB3 has it look
there alone. A port without a bridge is listed with the reason.)";

constexpr const char* help_examples = R"(Examples:
  roio-cli help send
  roio-cli help bridge set)";

constexpr const char* commands =
    "send, ask, dump, top, record, play, gen, buses, hub, attach, bridge, kind, robot or help";

/// The words with `help COMMAND` said as `COMMAND --help`.
std::vector<const char*> with_help(int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (words.size() > 1 && std::string_view(words[1]) == "help") {
    words.erase(words.begin() + 1);
    words.push_back("--help");
  }
  return words;
}

/// The command whose words were read last.
const CLI::App& last_command(const CLI::App& app) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) {
    last = last->get_subcommands().front();
  }
  return *last;
}

/// What is wrong with the number of an option's values, as CLI11 names it.
[[noreturn]] void refuse_values(const CLI::App& app, std::string_view what) {
  std::string name(what.substr(0, what.find_first_of(": ")));
  name.insert(0, name.starts_with('-') ? "" : "--");
  const CLI::Option* const option = last_command(app).get_option_no_throw(name);
  if (option != nullptr && option->get_items_expected_max() == 0) {
    throw UsageError(name + ": expected no value after it");
  }
  if (option != nullptr && option->count() > 1) {
    throw UsageError(name + ": given twice; expected once");
  }
  throw UsageError(name + ": expected a value after it");
}

/// Of a command with several forms, which ask for different things, the one that was meant.
template <typename... Forms>
Command as_command(std::variant<Forms...> forms) {
  return std::visit([](auto options) { return Command(std::move(options)); }, std::move(forms));
}
template <typename Options>
Command as_command(Options options) {
  return Command(std::move(options));
}

/// What the words of the command that was given ask for; none: no command was.
template <typename... Words>
std::optional<Command> parse_given(const Words&... all) {
  std::optional<Command> command;
  const auto parse_if_given = [&command](const auto& words) {
    if (words.parsed()) {
      command = as_command(words.parse());
    }
  };
  (parse_if_given(all), ...);
  return command;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Sends and shows Roio messages on a CAN bus, and looks after bridges.");
  prepare(app, "COMMAND [OPTIONS] ...", main_examples);
  bool version = false;
  app.add_flag("--version", version, "Print the version and end")->disable_flag_override();
  app.require_subcommand(0, 1);
  const SendWords send_words(app);
  const AskWords ask_words(app);
  const DumpWords dump_words(app);
  const TopWords top_words(app);
  const RecordWords record_words(app);
  const PlayWords play_words(app);
  const GenWords gen_words(app);
  CLI::App& buses_app = *app.add_subcommand("buses", "List the buses that can be opened");
  prepare(buses_app, "buses [OPTIONS]", buses_examples);
  const CLI::Option* buses_json = flag(buses_app, "--json", "JSON lines");
  const HubWords hub_words(app);
  const AttachWords attach_words(app);
  const BridgeWords bridge_words(app);
  const KindWords kind_words(app);
  const RobotWords robot_words(app);
  prepare(*app.add_subcommand("help", "Print the help of a command"), "help [COMMAND...]",
          help_examples);

  const std::vector<const char*> words = with_help(argc, argv);
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::CallForHelp&) {
    refuse_rest(app, "", commands);
    bridge_words.refuse_unknown();
    kind_words.refuse_unknown();
    robot_words.refuse_unknown();
    return Information{app.help()};
  } catch (const CLI::ArgumentMismatch& error) {
    refuse_values(app, error.what());
  } catch (const CLI::ParseError& error) {
    const auto parsed = app.get_subcommands();
    refuse(parsed.empty() ? "" : parsed.front()->get_name(), error.what());
  }
  if (version) {
    return Information{"roio-cli " ROIO_VERSION "\n"};
  }
  const bool is_alone = app.get_subcommands().empty();
  refuse_rest(app, is_alone ? "" : last_command(app).get_name(), is_alone ? commands : nullptr);
  if (buses_app.parsed()) {
    refuse_rest(buses_app, "buses");
    return BusesOptions{buses_json->count() > 0};
  }
  if (auto command =
          parse_given(send_words, ask_words, dump_words, top_words, record_words, play_words,
                      gen_words, hub_words, attach_words, bridge_words, kind_words, robot_words)) {
    return std::move(*command);
  }
  refuse("", std::string("expected a command: ") + commands);
}

}  // namespace roio::cli
