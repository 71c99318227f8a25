#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <functional>
#include <roio/text.hpp>
#include <roio/version.hpp>
#include <utility>

#include "board_words.hpp"
#include "program/exit_status.hpp"

namespace roio::sim_tool {
namespace {

using cli::UsageError;

constexpr const char* examples =
    R"(BOARD is uno, nano, leonardo, micro or mega. FILE is a sketch (Fan/Fan.ino or
its folder), which is built first, or an ELF file that the compiler made of one.
NAME is what its lines begin with and commands call it; else uno, uno2, ...
Each board has an MCP2515: SPI, chip select on pin 10, INT on pin 2.
Roio itself has sketches, in firmware/arduino/examples and bridge_usb.

Examples:
  roio-sim uno=Fan/Fan.ino                      a sketch of your own
  roio-sim uno=Fan.elf                          what the compiler made of it
  roio-sim --bus local:robot arm:uno=ServoController sensors:uno=SensorBoard
  roio-cli send local:robot 0.2 5A2D00          in another terminal: servos
  roio-sim --for 10 --speed max --json uno=Fan
  roio-sim --do 'fan analog A0 0.5' fan:uno=Fan
  roio-sim --serial-pty usb:/tmp/ttyACM0 usb:uno=bridge_usb fan:uno=Fan
  roio-cli send serial:/tmp/ttyACM0 0.2 01      in another terminal: bridge

Commands, a line each, on standard input (and with --do):
)";

[[noreturn]] void refuse(const std::string& what) {
  throw UsageError(what + "; `roio-sim --help` shows how");
}

template <typename T>
T value_or_refuse(const Parsed<T>& parsed, const std::string& option) {
  if (!parsed) {
    throw UsageError(option + parsed.error().message);
  }
  return *parsed;
}

/// The words, as they come.
struct Words {
  std::vector<std::string> bus, rate, speed, end;
  std::vector<std::string> boards, crystals, chip_selects, interrupts, terminals, commands;
  bool json = false, verbose = false, version = false;
};

void declare(CLI::App& app, Words& words) {
  app.add_option("BOARD", words.boards, "[NAME:]BOARD=FILE")->type_name("");
  // CLI11 would have a word of its own for an empty value, and for one too many: single() has ours.
  const auto one = [&app](const char* name, std::vector<std::string>& values, const char* type,
                          const char* description) {
    app.add_option(name, values, description)
        ->type_name(type)
        ->allow_extra_args(false)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  const auto of_boards = [&app](const char* name, std::vector<std::string>& values,
                                const char* type, const char* description) {
    app.add_option(name, values, description)->type_name(type)->allow_extra_args(false);
  };
  one("--bus", words.bus, "BUS", "Join the simulated bus to this: local:NAME, or can0");
  one("--rate", words.rate, "BPS", "Of the simulated bus, bit/s (default 500000)");
  of_boards("--crystal", words.crystals, "[NAME:]HZ", "Of the MCP2515 (default 16000000)");
  of_boards("--cs", words.chip_selects, "[NAME:]PIN", "Where chip select is (default 10)");
  of_boards("--int", words.interrupts, "[NAME:]PIN|none", "Where INT is (default 2)");
  of_boards("--serial-pty", words.terminals, "NAME[:PATH]",
            "Its serial port as a terminal, at PATH or as told");
  of_boards("--do", words.commands, "COMMAND", "Do this first; may be given several times");
  one("--speed", words.speed, "X|max", "Times real time (default 1); max: as fast as it goes");
  one("--for", words.end, "SECONDS", "End after so much simulated time");
  app.add_flag("--json", words.json)->description("JSON lines");
  app.add_flag("-v,--verbose", words.verbose)->description("Say on standard error when it runs");
  app.add_flag("--version", words.version, "Print the version and end");
}

// The value of an option that may be given once.
std::optional<std::string> single(const std::vector<std::string>& values,
                                  const std::string& option) {
  if (values.size() > 1) {
    throw UsageError(option + ": expected once, found " + quote(values[0]) + " and " +
                     quote(values[1]));
  }
  return values.empty() ? std::nullopt : std::optional(values.front());
}

double parse_speed(const std::string& text) {
  constexpr double slowest = 0.001;
  constexpr double fastest = 1000;
  if (text == "max") {
    return 0;
  }
  double speed = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, speed, std::chars_format::fixed);
  if (error != std::errc() || end != last || !(speed >= slowest && speed <= fastest)) {
    throw UsageError("--speed: expected 0.001..1000 or max, found " + quote(text));
  }
  return speed;
}

bool is_taken(const std::vector<BoardWish>& boards, const std::string& name) {
  return std::any_of(boards.begin(), boards.end(),
                     [&](const BoardWish& board) { return board.name == name; });
}

std::string free_name(const std::vector<BoardWish>& boards, const std::string& kind) {
  std::string name = kind;
  for (int number = 2; is_taken(boards, name); ++number) {
    name = kind + std::to_string(number);
  }
  return name;
}

std::vector<BoardWish> parse_boards(const std::vector<std::string>& words) {
  std::vector<BoardWish> boards;
  std::vector<BoardWord> parsed;
  for (const std::string& word : words) {
    parsed.push_back(value_or_refuse(parse_board_word(word), ""));
    BoardWish wish;
    wish.name = parsed.back().name;
    wish.kind = parsed.back().kind;
    wish.kind_word = parsed.back().kind_word;
    wish.elf = parsed.back().file;
    if (!wish.name.empty() && is_taken(boards, wish.name)) {
      throw UsageError("board " + quote(word) + ": expected another name, " + quote(wish.name) +
                       " is taken");
    }
    boards.push_back(std::move(wish));
  }
  // After all names that were given, so that none of them is taken.
  for (std::size_t i = 0; i < boards.size(); ++i) {
    if (boards[i].name.empty()) {
      boards[i].name = free_name(boards, parsed[i].kind_word);
    }
  }
  return boards;
}

// Does something to the board that the word before the colon names, or to all.
void for_named(std::vector<BoardWish>& boards, const std::string& option,
               const std::optional<std::string>& name,
               const std::function<void(BoardWish&)>& change) {
  if (name && !is_taken(boards, *name)) {
    std::string names;
    for (const BoardWish& board : boards) {
      names += (names.empty() ? "" : ", ") + board.name;
    }
    throw UsageError(option + ": no board " + quote(*name) + "; there is " + names);
  }
  for (BoardWish& board : boards) {
    if (!name || board.name == *name) {
      change(board);
    }
  }
}

// "NAME" or "NAME:PATH"
void add_terminal(std::vector<BoardWish>& boards, const std::string& word) {
  const std::size_t colon = word.find(':');
  const std::string path = colon == std::string::npos ? "" : word.substr(colon + 1);
  if (colon == 0 || word.empty() || (colon != std::string::npos && path.empty())) {
    throw UsageError("--serial-pty: expected NAME or NAME:PATH, found " + quote(word));
  }
  for (const BoardWish& board : boards) {
    if (!path.empty() && board.terminal_link == path) {
      throw UsageError("--serial-pty: expected another path for " + quote(word) +
                       ", this one is for " + board.name);
    }
  }
  for_named(boards, "--serial-pty", word.substr(0, colon), [&](BoardWish& board) {
    board.has_terminal = true;
    board.terminal_link = path;
  });
}

int pin_of(const BoardWish& board, const std::string& option, const PinName& pin) {
  try {
    return number_of(board.kind, pin);
  } catch (const std::invalid_argument& error) {
    throw UsageError(option + board.name + ": " + error.what());
  }
}

void apply_to_boards(const Words& words, std::vector<BoardWish>& boards) {
  for (const std::string& word : words.crystals) {
    const NamedValue named = split_named_value(word);
    const auto hz =
        value_or_refuse(parse_whole_number(named.value, 1'000'000, 40'000'000), "--crystal: ");
    for_named(boards, "--crystal", named.name,
              [&](BoardWish& board) { board.options.chip.osc_hz = hz; });
  }
  for (const std::string& word : words.chip_selects) {
    const NamedValue named = split_named_value(word);
    const auto pin = value_or_refuse(parse_pin_name(named.value), "--cs: ");
    for_named(boards, "--cs", named.name, [&](BoardWish& board) {
      board.options.chip_select_pin = pin_of(board, "--cs: ", pin);
    });
  }
  for (const std::string& word : words.interrupts) {
    const NamedValue named = split_named_value(word);
    std::optional<PinName> pin;
    if (named.value != "none") {
      const auto parsed = parse_pin_name(named.value);
      if (!parsed) {
        throw UsageError("--int: expected none, or a pin such as 3 or A0, found " +
                         quote(named.value));
      }
      pin = *parsed;
    }
    for_named(boards, "--int", named.name, [&](BoardWish& board) {
      board.options.interrupt_pin =
          pin ? std::optional(pin_of(board, "--int: ", *pin)) : std::nullopt;
    });
  }
  for (const std::string& word : words.terminals) {
    add_terminal(boards, word);
  }
}

Options parse(const Words& words) {
  constexpr std::uint32_t slowest_bps = 5'000;
  constexpr std::uint32_t fastest_bps = 1'000'000;
  if (words.boards.empty()) {
    refuse("expected a board: [NAME:]BOARD=FILE");
  }
  Options options;
  options.bus = single(words.bus, "--bus");
  if (options.bus) {
    static_cast<void>(value_or_refuse(parse_bus_url(*options.bus), ""));
  }
  const std::string rate = single(words.rate, "--rate").value_or("500000");
  options.bitrate_bps =
      value_or_refuse(parse_whole_number(rate, slowest_bps, fastest_bps), "--rate: ");
  options.speed = parse_speed(single(words.speed, "--speed").value_or("1"));
  if (const auto end = single(words.end, "--for")) {
    options.end = value_or_refuse(parse_seconds(*end), "--for: ");
  }
  options.boards = parse_boards(words.boards);
  apply_to_boards(words, options.boards);
  for (const std::string& command : words.commands) {
    options.instructions.push_back(
        value_or_refuse(parse_instruction(command), "--do " + quote(command) + ": "));
  }
  options.json = words.json;
  options.verbose = words.verbose;
  return options;
}

/// CLI11's help, but for the first line, in which it would name every option's type.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(28); }
  std::string make_usage(const CLI::App* /*app*/, std::string /*name*/) const override {
    return "Usage: roio-sim [OPTIONS] [NAME:]BOARD=FILE...\n";
  }
};

}  // namespace

std::variant<Information, Options> parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Runs Arduino firmware on simulated boards, on one simulated CAN bus.");
  app.allow_extras();
  app.footer(std::string(examples) + command_help);
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help and end");
  Words words;
  declare(app, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return Information{app.help()};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string_view what = error.what();
    throw UsageError(std::string(what.substr(0, what.find(':'))) + ": expected a value after it");
  } catch (const CLI::ParseError& error) {
    refuse(error.what());
  }
  if (words.version) {
    return Information{"roio-sim " ROIO_VERSION "\n"};
  }
  auto rest = app.remaining();
  std::erase(rest, "--");  // what follows it is taken as a board already
  if (!rest.empty()) {
    refuse("unknown option " + quote(rest.front()));
  }
  return parse(words);
}

}  // namespace roio::sim_tool
