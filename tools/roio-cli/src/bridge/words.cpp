#include "bridge/words.hpp"

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* bridge_examples = R"(Examples:
  roio-cli bridge show /dev/ttyACM0          what it is, and what it has counted
  roio-cli bridge set auto --bitrate 125000  the only bridge there is
  roio-cli bridge attach /dev/ttyACM0 vcan0  for every Linux program with CAN

PORT is a serial port, auto for the only bridge there is, or the whole name of
the bus: serial:/dev/ttyACM0?bitrate=125000. One program at a time has it.
`roio-cli buses` looks for bridges.
More: man roio-cli-bridge, roio-cli bridge show --help)";

constexpr const char* show_examples = R"(Examples:
  roio-cli bridge show /dev/ttyACM0
  roio-cli bridge show --json auto | jq .counters.dropped)";

constexpr const char* set_examples = R"(Examples:
  roio-cli bridge set /dev/ttyACM0 --bitrate 125000
  roio-cli bridge set /dev/ttyACM0 --mode listen
  roio-cli bridge set /dev/ttyACM0 --address 0.9

It holds until the board is reset or unplugged. To have it whatever has been
before, say it in the name of the bus:
  roio-cli dump 'serial:/dev/ttyACM0?bitrate=125000&mode=listen')";

constexpr const char* identify_examples = R"(Examples:
  roio-cli bridge identify /dev/ttyACM0
  roio-cli bridge identify /dev/ttyACM0 --seconds 60
  roio-cli bridge identify /dev/ttyACM0 --seconds 0    end it now)";

constexpr const char* attach_examples = R"(Examples:
  roio-cli bridge attach /dev/ttyACM0 vcan0 &
  candump vcan0                                what is on the bridge's bus
  cansend vcan0 1000400A#5A2D00                goes out to it
  roio-cli bridge attach 'serial:auto?bitrate=125000' local:robot

`sudo ip link add vcan0 type vcan; sudo ip link set vcan0 up` makes a vcan0.
Every frame goes both ways until a signal ends it. The bridge may be unplugged
and BUS go down meanwhile; what one side does not take within a second is lost
and counted. At the end (with -v once a second) it says what was forwarded, and
what was lost where.)";

constexpr const char* commands = "show, set, identify or attach";

/// @return PORT as the name of a bus.
std::string parse_port(const std::string& text) {
  constexpr const char* expected = "PORT: expected a serial port such as /dev/ttyACM0, or auto";
  const bool is_url = text.starts_with("serial:");
  if (!is_url && text != "auto" && text.find('/') == std::string::npos) {
    throw UsageError(std::string(expected) + ", found " + quote(text));
  }
  return parse_bus(is_url ? text : "serial:" + text);
}

}  // namespace

BridgeWords::BridgeWords(CLI::App& program)
    : app_(program.add_subcommand("bridge", "Show, set and use a bridge on a serial port")),
      show_(&declare("show", "Show what a bridge is and has counted", "bridge show [OPTIONS] PORT",
                     show_examples)),
      set_(&declare("set", "Set a bridge's bit rate, mode and address", "bridge set [OPTIONS] PORT",
                    set_examples)),
      identify_(&declare("identify", "Have a bridge's LED blink", "bridge identify [OPTIONS] PORT",
                         identify_examples)),
      attach_(&declare("attach", "Make a bridge and another bus one bus",
                       "bridge attach [OPTIONS] PORT BUS", attach_examples)),
      json_(flag(*show_, "--json", "One JSON object")),
      bitrate_(set_->add_option("--bitrate", bitrate_text_, "Of the CAN bus")->type_name("BPS")),
      mode_(set_->add_option("--mode", mode_text_,
                             "normal, listen (drives nothing) or loopback (own frames)")
                ->type_name("NAME")),
      address_(set_->add_option("--address", address_text_,
                                "That it answers to as a node; none: it is no node")
                   ->type_name("SUBNET.NODE")),
      verbose_(flag(*attach_, "-v,--verbose", "Say the counts once a second")) {
  prepare(*app_, "bridge show|set|identify|attach [OPTIONS] PORT ...", bridge_examples);
  app_->require_subcommand(0, 1);
  identify_->add_option("--seconds", seconds_text_, "How long (default 5); 0 ends it")
      ->type_name("N");
  without_type(attach_->add_option("BUS", bus_, "vcan0, can0, or local:NAME"));
}

CLI::App& BridgeWords::declare(const char* name, const char* description, const char* usage,
                               const char* examples) {
  CLI::App& app = *app_->add_subcommand(name, description);
  prepare(app, usage, examples);
  without_type(app.add_option("PORT", port_, "/dev/ttyACM0, or auto"));
  return app;
}

std::string BridgeWords::port_of(const CLI::App& app) const {
  const std::string command = "bridge " + app.get_name();
  refuse_rest(app, command);
  if (port_.empty()) {
    refuse(command, "expected PORT");
  }
  return parse_port(port_);
}

BridgeShowOptions BridgeWords::parse_show() const {
  return {port_of(*show_), json_->count() > 0};
}

BridgeSetOptions BridgeWords::parse_set() const {
  constexpr std::uint64_t slowest_bps = 1000;
  constexpr std::uint64_t fastest_bps = 1000000;
  BridgeSetOptions options;
  refuse_rest(*set_, "bridge set");
  if (bitrate_->count() > 0) {
    options.bitrate_bps = static_cast<std::uint32_t>(
        parse_number("--bitrate", bitrate_text_, slowest_bps, fastest_bps));
  }
  if (mode_->count() > 0) {
    options.mode = value_or_refuse(parse_bridge_mode(mode_text_), "--mode: ");
  }
  options.set_address = address_->count() > 0;
  if (options.set_address && address_text_ != "none") {
    options.address = value_or_refuse(parse_source(address_text_), "--address: ");
  }
  options.port = port_of(*set_);
  if (!options.bitrate_bps && !options.mode && !options.set_address) {
    refuse("bridge set", "expected --bitrate, --mode or --address");
  }
  return options;
}

BridgeIdentifyOptions BridgeWords::parse_identify() const {
  constexpr std::uint64_t longest_s = 255;
  refuse_rest(*identify_, "bridge identify");
  const std::chrono::seconds duration(parse_number("--seconds", seconds_text_, 0, longest_s));
  return {port_of(*identify_), duration};
}

AttachOptions BridgeWords::parse_attach() const {
  AttachOptions options;
  options.first = port_of(*attach_);
  if (bus_.empty()) {
    refuse("bridge attach", "expected BUS after PORT: an interface such as vcan0, or local:NAME");
  }
  options.second = parse_bus(bus_);
  if (parse_bus_url(bus_)->kind == BusUrl::Kind::serial) {
    throw UsageError("BUS: expected an interface such as vcan0, or local:NAME, found " +
                     quote(bus_));
  }
  options.verbose = verbose_->count() > 0;
  return options;
}

void BridgeWords::refuse_unknown() const {
  refuse_rest(*app_, "bridge", commands);
}

Command BridgeWords::parse() const {
  // Behind "--" words come back that a command of its own has no place for.
  for (const CLI::App* command : app_->get_subcommands()) {
    refuse_rest(*app_, "bridge " + command->get_name());
  }
  if (show_->parsed()) {
    return parse_show();
  }
  if (set_->parsed()) {
    return parse_set();
  }
  if (identify_->parsed()) {
    return parse_identify();
  }
  if (attach_->parsed()) {
    return parse_attach();
  }
  refuse_unknown();
  refuse("bridge", std::string("expected a command: ") + commands);
}

}  // namespace roio::cli
