#include "top/words.hpp"

#include <limits>

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples = R"(Examples:
  roio-cli top can0
  roio-cli top --bitrate 500000 local:robot    the load, too
  roio-cli top local:robot > traffic.json      JSON lines, once a second
  roio-cli top -n 1 --interval 5000 can0 | jq 'select(.type == "row")'

A row for each source, destination and length: how often it comes, how long ago
it last did (dim: silent for more than 2 s and 3 of its periods), and its last
bytes, a star behind each that changed. On top: the state of the bus, its load
from the lengths of the frames, exactly, and what was lost. The load needs the
bit rate: the kernel and a bridge tell it, and the name of a local bus
(local:robot?bitrate=500000); else --bitrate does.

Keys: q quit, s sort by another column, r the other way round, p pause, c clear,
arrows and PgUp PgDn scroll, h help.)";

}  // namespace

TopWords::TopWords(CLI::App& program)
    : app_(program.add_subcommand("top", "Show who is on a bus, live")),
      robot_(*app_),
      bitrate_(option(*app_, "--bitrate", bitrate_text_, "BPS",
                      "Bit rate of a bus that does not tell, for its load")),
      interval_(option(*app_, "--interval", interval_text_, "MS",
                       "Between two screens (250), or sets of lines (1000)")),
      count_(option(*app_, "-n", count_text_, "N", "End after N of them")),
      json_(flag(*app_, "--json", "JSON lines, also on a terminal")) {
  prepare(*app_, "top [OPTIONS] [BUS]", examples);
  without_type(app_->add_option("BUS", bus_, "can0, local:NAME or serial:DEVICE"));
}

TopOptions TopWords::parse() const {
  constexpr std::uint64_t shortest_ms = 10;
  TopOptions options;
  refuse_rest(*app_, "top");
  if (bitrate_->count() > 0) {
    options.bitrate_bps = parse_bitrate(bitrate_text_);
  }
  if (interval_->count() > 0) {
    options.interval = parse_ms("--interval", interval_text_, shortest_ms);
  }
  if (count_->count() > 0) {
    options.count = parse_number("-n", count_text_, 1, std::numeric_limits<std::uint32_t>::max());
  }
  options.json = json_->count() > 0;
  options.robot = robot_.find();
  options.bus = parse_bus_or_robots(options.robot.get(), bus_, "top");
  return options;
}

}  // namespace roio::cli
