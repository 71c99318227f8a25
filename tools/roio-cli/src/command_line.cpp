#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <limits>
#include <roio/text.hpp>
#include <roio/version.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "bridge_words.hpp"
#include "words.hpp"

namespace roio::cli {
namespace {

constexpr const char* main_examples = R"(Examples:
  roio-cli dump local:robot &               listen on a bus that needs nothing
  roio-cli send local:robot 0.2 5A2D00      three bytes to node 2 of subnet 0
  roio-cli dump can0 to=0.2 urgent          urgent messages to that node, on SocketCAN
  roio-cli dump serial:auto                 through the bridge on a serial port
  roio-cli buses                            what there is to be opened
  roio-cli bridge attach /dev/ttyACM0 vcan0 a bridge, for every Linux program

BUS is a CAN interface (can0), serial:DEVICE, a bridge on a serial port, or
local:NAME, a bus between the programs of one user on this machine;
local:NAME?bitrate=500000 has the pace of a real one.
Exit status: 0 done, 1 failed, 2 not a right command line, 128+N ended by signal N.
More: man roio-cli, roio-cli send --help, roio-cli bridge --help)";

constexpr const char* send_examples = R"(Examples:
  roio-cli send can0 0.2 5A2D00              three bytes to node 2 of subnet 0
  roio-cli send can0 0.2 --dec 90 45 0       the same, in decimal
  roio-cli send --urgent can0 '0.*' 00       urgent, to everybody in subnet 0
  roio-cli send --count 10 --interval 100 can0 0.2 01
  roio-cli send can0 - < messages.json       a message a line, as JSON
  roio-cli send can1 - < candump.log         replay what candump -L or dump --log kept

Lines read from standard input say themselves where they go. A line that cannot
be understood is named on standard error, the others are sent, and the exit
status is 1. Quote '0.*' for the shell, or write 0.255.)";

constexpr const char* dump_examples = R"(FILTER is one of
  to=0.2      to node 0.2             to=0.*    broadcast to subnet 0
  to=0.any    either, for any node    from=0.3  from node 0.3
  from=0.*    from anyone in subnet 0
  urgent, normal, class=message|system|stream
  123:7FF     identifier and mask in hexadecimal, as candump takes them
  123~7FF     all but these           (8 digits: an extended identifier)
Words of one kind widen, words of different kinds narrow, ID~MASK takes away,
and "or" between words begins another choice.

Examples:
  roio-cli dump can0                         everything
  roio-cli dump can0 to=0.2 'to=0.*'         what node 0.2 hears
  roio-cli dump can0 to=0.2 or from=0.2      what node 0.2 hears or says
  roio-cli dump -n 1 -T 1000 can0 from=0.3   one message; exit 1 if none within 1 s
  roio-cli dump --log can0 > drive.log       as candump -L, for canplayer and send
  roio-cli dump --json can0 | jq .data       one JSON object a line)";

constexpr const char* buses_examples = R"(Examples:
  roio-cli buses
  roio-cli buses --json | jq -r 'select(.kind == "serial").bus'

CAN interfaces, the local buses that some program is on, and bridges. To find
those it opens the serial ports that an Arduino may be at and no other program
has; that restarts most Arduinos. ROIO_SERIAL_PORTS=/dev/ttyUSB3 has it look
there alone. A port without a bridge is listed with the reason.)";

Bytes parse_decimal(std::span<const std::string> words) {
  Bytes bytes;
  if (words.size() > bytes.data.size()) {
    throw UsageError("DATA: expected at most 8 bytes, found " + std::to_string(words.size()));
  }
  for (const std::string& word : words) {
    bytes.data[bytes.length++] =
        static_cast<std::uint8_t>(parse_number("DATA with --dec", word, 0, 255));
  }
  return bytes;
}

Bytes parse_data(std::span<const std::string> words, bool decimal) {
  if (decimal) {
    return parse_decimal(words);
  }
  if (words.size() > 1) {
    throw UsageError(
        "DATA: expected one word of hexadecimal digits such as 5A2D00 (or --dec before decimal "
        "numbers), found " +
        std::to_string(words.size()) + " words");
  }
  return words.empty() ? Bytes{} : value_or_refuse(parse_hex(words.front()));
}

/// The words of `send`, as they come.
struct SendWords {
  std::string bus, destination, from_text;
  std::string class_text = "message";
  std::string count_text = "1", interval_text = "0", timeout_text = "1000";
  std::vector<std::string> data;
  CLI::Option* dec = nullptr;
  CLI::Option* from = nullptr;
  CLI::Option* urgent = nullptr;
  CLI::Option* message_class = nullptr;
  CLI::Option* count = nullptr;
  CLI::Option* interval = nullptr;
};

void declare(CLI::App& app, SendWords& words) {
  without_type(app.add_option("BUS", words.bus, "can0, local:NAME or serial:DEVICE"));
  without_type(
      app.add_option("DEST", words.destination,
                     "SUBNET.NODE, or SUBNET.* for everybody there; - reads standard input"));
  without_type(
      app.add_option("DATA", words.data, "0 to 8 bytes in hexadecimal: 5A2D00 or 5A.2D.00"));
  words.dec = flag(app, "--dec", "DATA are decimal numbers, one a byte: 90 45 0");
  words.from = app.add_option("--from", words.from_text, "Source address (default 0.10)");
  words.from->type_name("SUBNET.NODE");
  words.urgent = flag(app, "--urgent", "Ahead of normal messages");
  words.message_class =
      app.add_option("--class", words.class_text, "message (default), system or stream");
  words.message_class->type_name("NAME");
  words.count = app.add_option("--count", words.count_text, "Send N times; 0: until interrupted");
  words.count->type_name("N");
  words.interval =
      app.add_option("--interval", words.interval_text, "Time from one message to the next");
  words.interval->type_name("MS");
  app.add_option("--timeout", words.timeout_text,
                 "Give up when a message has waited so long for the bus (default 1000)")
      ->type_name("MS");
}

// Which options make no sense with lines that say everything themselves.
void refuse_with_lines(const SendWords& words) {
  for (const CLI::Option* option : {words.dec, words.urgent, words.message_class, words.count}) {
    if (option->count() > 0) {
      throw UsageError(option->get_name() +
                       ": expected without DEST -, as each line of the input says its own");
    }
  }
  if (!words.data.empty()) {
    throw UsageError("DATA: expected none after DEST -, as each line of the input has its own");
  }
}

MessageClass parse_sendable_class(const std::string& text) {
  const auto message_class = parse_class(text);
  if (!message_class || *message_class == MessageClass::reserved) {
    throw UsageError("--class: expected message, system or stream, found " + quote(text));
  }
  return *message_class;
}

Message parse_message(const SendWords& words, Address source) {
  Message message{};
  message.header.destination = value_or_refuse(parse_address(words.destination));
  message.header.source = source;
  message.header.priority = words.urgent->count() > 0 ? Priority::urgent : Priority::normal;
  message.header.message_class = parse_sendable_class(words.class_text);
  const Bytes bytes = parse_data(words.data, words.dec->count() > 0);
  message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), message.data);
  return message;
}

SendOptions parse_send(const SendWords& words) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  if (words.bus.empty()) {
    refuse("send", "expected BUS, DEST and DATA");
  }
  if (words.destination.empty()) {
    refuse("send", "expected DEST after BUS: SUBNET.NODE, SUBNET.* or -");
  }
  SendOptions options;
  options.bus = parse_bus(words.bus);
  if (words.from->count() > 0) {
    options.source = value_or_refuse(parse_source(words.from_text), "--from: ");
  }
  options.count = parse_number("--count", words.count_text, 0, most);
  options.interval = parse_ms("--interval", words.interval_text, 0);
  options.timeout = parse_ms("--timeout", words.timeout_text, 1);
  if (words.destination == "-") {
    refuse_with_lines(words);
    return options;
  }
  if (words.interval->count() > 0 && words.count->count() == 0) {
    throw UsageError("--interval: expected with --count N (0: until interrupted)");
  }
  options.message = parse_message(words, options.source);
  return options;
}

/// The words of `dump`, as they come.
struct DumpWords {
  std::string bus, count_text, quiet_text, time_text;
  std::vector<std::string> filters;
  CLI::Option* count = nullptr;
  CLI::Option* quiet = nullptr;
  CLI::Option* time = nullptr;
  CLI::Option* log = nullptr;
  CLI::Option* json = nullptr;
  CLI::Option* no_foreign = nullptr;
  CLI::Option* errors = nullptr;
  CLI::Option* verbose = nullptr;
};

void declare(CLI::App& app, DumpWords& words) {
  without_type(app.add_option("BUS", words.bus, "can0, local:NAME or serial:DEVICE"));
  without_type(app.add_option("FILTER", words.filters, "Which frames; see below"));
  words.count = app.add_option("-n", words.count_text, "End after N frames");
  words.count->type_name("N");
  words.quiet =
      app.add_option("-T", words.quiet_text, "End after MS without a frame (1 if -n not reached)");
  words.quiet->type_name("MS");
  words.time = app.add_option("-t", words.time_text,
                              "Time: a absolute, d since the frame before, z since the first");
  words.time->type_name("a|d|z");
  words.log = flag(app, "--log", "candump -L's lines, byte for byte; notes go to standard error");
  words.json = flag(app, "--json", "JSON lines");
  words.no_foreign = flag(app, "--no-foreign", "Hide what is no Roio message (11-bit, remote)");
  words.errors = flag(app, "--errors", "Show the controller's error reports too");
  words.verbose = flag(app, "-v,--verbose", "Say on standard error when listening, and the counts");
}

TimeColumn::Mode parse_time_mode(const std::string& text) {
  if (text != "a" && text != "d" && text != "z") {
    throw UsageError("-t: expected a (absolute), d (delta) or z (zero), found " + quote(text));
  }
  return static_cast<TimeColumn::Mode>(text.front());
}

DumpOptions parse_dump(const DumpWords& words) {
  if (words.bus.empty()) {
    refuse("dump", "expected BUS");
  }
  if (words.log->count() > 0 && words.json->count() > 0) {
    throw UsageError("expected either --log or --json, not both");
  }
  DumpOptions options;
  options.bus = parse_bus(words.bus);
  options.filters = words.filters;
  if (words.count->count() > 0) {
    options.count =
        parse_number("-n", words.count_text, 1, std::numeric_limits<std::uint32_t>::max());
  }
  if (words.quiet->count() > 0) {
    options.quiet_time = parse_ms("-T", words.quiet_text, 1);
  }
  options.form = words.log->count() > 0    ? DumpOptions::Form::log
                 : words.json->count() > 0 ? DumpOptions::Form::json
                                           : DumpOptions::Form::text;
  if (words.time->count() > 0) {
    if (options.form != DumpOptions::Form::text) {
      throw UsageError("-t: expected without --log and --json, which have a time of their own");
    }
    options.time = parse_time_mode(words.time_text);
  }
  options.no_foreign = words.no_foreign->count() > 0;
  options.errors = words.errors->count() > 0;
  options.verbose = words.verbose->count() > 0;
  return options;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Sends and shows Roio messages on a CAN bus, and looks after bridges.");
  prepare(app, "send|dump|buses|bridge [OPTIONS] ...", main_examples);
  bool version = false;
  app.add_flag("--version", version, "Print the version and end");
  app.require_subcommand(0, 1);
  CLI::App& send_app = *app.add_subcommand("send", "Send a message, or lines of them");
  CLI::App& dump_app = *app.add_subcommand("dump", "Show what is on a bus");
  prepare(send_app, "send [OPTIONS] BUS DEST [DATA]", send_examples);
  prepare(dump_app, "dump [OPTIONS] BUS [FILTER...]", dump_examples);
  SendWords send_words;
  DumpWords dump_words;
  declare(send_app, send_words);
  declare(dump_app, dump_words);
  CLI::App& buses_app = *app.add_subcommand("buses", "List the buses that can be opened");
  prepare(buses_app, "buses [OPTIONS]", buses_examples);
  const CLI::Option* buses_json = flag(buses_app, "--json", "JSON lines");
  const BridgeWords bridge_words(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return Information{app.help()};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string_view what = error.what();
    throw UsageError(std::string(what.substr(0, what.find(':'))) + ": expected a value after it");
  } catch (const CLI::ParseError& error) {
    const auto parsed = app.get_subcommands();
    refuse(parsed.empty() ? "" : parsed.front()->get_name(), error.what());
  }
  if (version) {
    return Information{"roio-cli " ROIO_VERSION "\n"};
  }
  if (send_app.parsed()) {
    refuse_rest(send_app, "send");
    return parse_send(send_words);
  }
  if (dump_app.parsed()) {
    refuse_rest(dump_app, "dump");
    return parse_dump(dump_words);
  }
  if (buses_app.parsed()) {
    refuse_rest(buses_app, "buses");
    return BusesOptions{buses_json->count() > 0};
  }
  if (bridge_words.parsed()) {
    return bridge_words.parse();
  }
  constexpr const char* commands = "send, dump, buses or bridge";
  refuse_rest(app, "", commands);
  refuse("", std::string("expected a command: ") + commands);
}

}  // namespace roio::cli
