#include "dump/words.hpp"

#include <limits>
#include <roio/text.hpp>

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples =
    R"(It ends by Ctrl-C, after -n N frames, or after -T MS without one.

FILTER is one of
  to=0.2      to node 0.2             to=0.*      broadcast to subnet 0
  to=0.any    either, for any node    from=0.any  from any node of subnet 0
  from=0.3    from node 0.3
  urgent, normal, class=message|system|stream
  123:7FF     identifier and mask in hexadecimal, as candump takes them
  123~7FF     all but these           (8 digits: an extended identifier)
Words of one kind widen, words of different kinds narrow, ID~MASK takes away,
and "or" between words begins another choice.

Examples:
  roio-cli dump can0                        everything, until Ctrl-C
  roio-cli dump can0 to=0.2 'to=0.*'        what node 0.2 hears
  roio-cli dump can0 to=0.2 or from=0.2     what node 0.2 hears or says
  roio-cli dump -n 1 -T 1000 can0 from=0.3  one message; 1 if none within 1 s
  roio-cli dump --log can0 > drive.log      for canplayer, log2asc and send
  roio-cli dump --json can0 | jq .data      one JSON object a line)";

TimeColumn::Mode parse_time_mode(const std::string& text) {
  if (text != "a" && text != "d" && text != "z") {
    throw UsageError("-t: expected a (absolute), d (delta) or z (zero), found " + quote(text));
  }
  return static_cast<TimeColumn::Mode>(text.front());
}

}  // namespace

DumpWords::DumpWords(CLI::App& program)
    : app_(program.add_subcommand("dump", "Show what is on a bus")),
      count_(option(*app_, "-n", count_text_, "N", "End after N frames")),
      quiet_(option(*app_, "-T", quiet_text_, "MS",
                    "End after MS without a frame (1 if -n not reached)")),
      time_(option(*app_, "-t", time_text_, "a|d|z",
                   "Time: absolute, since the frame before, the first")),
      log_(flag(*app_, "--log", "candump -L's lines; notes go to standard error")),
      json_(flag(*app_, "--json", "JSON lines")),
      no_foreign_(flag(*app_, "--no-foreign", "Hide what is no Roio message (11-bit, remote)")),
      errors_(flag(*app_, "--errors", "Show the controller's error reports too")),
      verbose_(flag(*app_, "-v,--verbose", "Tell on stderr when listening, and the counts")) {
  prepare(*app_, "dump [OPTIONS] BUS [FILTER...]", examples);
  without_type(app_->add_option("BUS", bus_, "can0, local:NAME or serial:DEVICE"));
  without_type(app_->add_option("FILTER", filters_, "Which frames; see below"));
}

DumpOptions DumpWords::parse_options() const {
  DumpOptions options;
  if (count_->count() > 0) {
    options.count = parse_number("-n", count_text_, 1, std::numeric_limits<std::uint32_t>::max());
  }
  if (quiet_->count() > 0) {
    options.quiet_time = parse_ms("-T", quiet_text_, 1);
  }
  if (time_->count() > 0) {
    options.time = parse_time_mode(time_text_);
  }
  if (log_->count() > 0 && json_->count() > 0) {
    throw UsageError("expected either --log or --json, not both");
  }
  options.form = log_->count() > 0    ? DumpOptions::Form::log
                 : json_->count() > 0 ? DumpOptions::Form::json
                                      : DumpOptions::Form::text;
  if (time_->count() > 0 && options.form != DumpOptions::Form::text) {
    throw UsageError("-t: expected without --log and --json, which have a time of their own");
  }
  options.no_foreign = no_foreign_->count() > 0;
  options.errors = errors_->count() > 0;
  options.verbose = verbose_->count() > 0;
  return options;
}

DumpOptions DumpWords::parse() const {
  refuse_rest(*app_, "dump");
  // First the options: in `dump -t local:robot`, what is wrong is not that BUS is missing.
  DumpOptions options = parse_options();
  if (bus_.empty()) {
    refuse("dump", "expected BUS");
  }
  options.bus = parse_bus(bus_);
  options.filters = filters_;
  return options;
}

}  // namespace roio::cli
