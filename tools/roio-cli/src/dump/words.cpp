#include "dump/words.hpp"

#include <roio/text.hpp>
#include <string>
#include <tuple>

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples =
    R"(It ends by Ctrl-C, after -n N frames, or after -T MS without one.

Several BUS are shown in one, with a column for the bus. A word after BUS is one
more when it is local:..., serial:... or a name and a number, as can1; -b BUS
names any.

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
  roio-cli dump -t A can0 can1 urgent       two buses, with date and time
  roio-cli dump --log can0 > drive.log      for canplayer, log2asc and play
  roio-cli dump --pcap can0 | wireshark -k -i -    live, in Wireshark
  roio-cli dump --json can0 | jq .data      one JSON object a line)";

TimeColumn::Mode parse_time_mode(const std::string& text) {
  if (text != "a" && text != "A" && text != "d" && text != "z") {
    throw UsageError("-t: expected a (absolute), A (with date), d (delta) or z (zero), found " +
                     quote(text));
  }
  return static_cast<TimeColumn::Mode>(text.front());
}

}  // namespace

DumpWords::DumpWords(CLI::App& program)
    : app_(program.add_subcommand("dump", "Show what is on a bus")),
      listen_(*app_),
      time_(option(*app_, "-t", time_text_, "a|A|d|z",
                   "Time: absolute, dated, since the last, the first")),
      log_(flag(*app_, "--log", "candump -L's lines; notes go to standard error")),
      json_(flag(*app_, "--json", "JSON lines")),
      csv_(flag(*app_, "--csv", "Comma-separated values, for spreadsheets")),
      pcap_(flag(*app_, "--pcap", "A capture for Wireshark, of one bus")),
      colour_(flag(*app_, "-c", "On a terminal, a colour for each source")),
      bytes_only_(flag(*app_, "-x", "Bytes, where the robot file has names for them")),
      verbose_(flag(*app_, "-v,--verbose", "Tell on stderr when listening, and the counts")) {
  prepare(*app_, "dump [OPTIONS] BUS... [FILTER...]", examples);
}

Form DumpWords::parse_form() const {
  Form form = Form::text;
  const char* given = nullptr;
  for (const auto& [option, name, meant] :
       {std::tuple(log_, "--log", Form::log), std::tuple(json_, "--json", Form::json),
        std::tuple(csv_, "--csv", Form::csv), std::tuple(pcap_, "--pcap", Form::pcap)}) {
    if (option->count() == 0) {
      continue;
    }
    if (given != nullptr) {
      throw UsageError(std::string("expected either ") + given + " or " + name + ", not both");
    }
    form = meant;
    given = name;
  }
  if (form != Form::text && (time_->count() > 0 || colour_->count() > 0)) {
    const bool time = time_->count() > 0;
    throw UsageError(std::string(time ? "-t" : "-c") + ": expected without " + given +
                     (time ? ", which has a time of its own" : ", which has no colours"));
  }
  return form;
}

DumpOptions DumpWords::parse_options() const {
  DumpOptions options;
  options.listen = listen_.parse_options();
  if (time_->count() > 0) {
    options.time = parse_time_mode(time_text_);
  }
  options.form = parse_form();
  options.colour_sources = colour_->count() > 0;
  options.bytes_only = bytes_only_->count() > 0;
  options.verbose = verbose_->count() > 0;
  return options;
}

DumpOptions DumpWords::parse() const {
  refuse_rest(*app_, "dump");
  // First the options: in `dump -t local:robot`, what is wrong is not that BUS is missing.
  DumpOptions options = parse_options();
  listen_.parse_words(options.listen);
  if (options.form == Form::pcap && options.listen.buses.size() > 1) {
    throw UsageError("--pcap: expected one BUS, as its form has no place for a bus's name");
  }
  return options;
}

}  // namespace roio::cli
