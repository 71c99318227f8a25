#include "record/record_words.hpp"

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples =
    R"(It ends by Ctrl-C, after -n N frames, or after -T MS without one. FILE is a log
as candump -l writes it; with a name that ends with .csv or .pcap, or with --csv
or --pcap, one of those. A FILE that is there is kept, unless --force is given.
BUS and FILTER are those of dump: roio-cli help dump.

Examples:
  roio-cli record can0                      to roio-2026-11-20_202026.log
  roio-cli record -o drive.log can0 can1    two buses in one log
  roio-cli record -o arm.log can0 to=0.2    what node 0.2 is told
  roio-cli record -o drive.pcap can0        for Wireshark
  roio-cli play drive.log can0              and back again)";

// How long frames may gather before they are taken: at 1 Mbit/s some 40 come meanwhile, and the
// least that the kernel keeps for anybody is 278.
constexpr std::chrono::milliseconds gather_time{5};

}  // namespace

RecordWords::RecordWords(CLI::App& program)
    : app_(program.add_subcommand("record", "Keep what is on a bus in a file")),
      file_(option(*app_, "-o", file_text_, "FILE", "Where to; without it, named by the date")),
      force_(flag(*app_, "--force", "Overwrite FILE when it is there")),
      csv_(flag(*app_, "--csv", "Comma-separated values, for spreadsheets")),
      pcap_(flag(*app_, "--pcap", "A capture for Wireshark, of one bus")),
      listen_(*app_) {
  prepare(*app_, "record [OPTIONS] BUS... [FILTER...]", examples);
}

Form RecordWords::parse_form() const {
  if (csv_->count() > 0 && pcap_->count() > 0) {
    throw UsageError("expected either --csv or --pcap, not both");
  }
  if (csv_->count() > 0 || (pcap_->count() == 0 && file_text_.ends_with(".csv"))) {
    return Form::csv;
  }
  return pcap_->count() > 0 || file_text_.ends_with(".pcap") ? Form::pcap : Form::log;
}

RecordOptions RecordWords::parse_options() const {
  RecordOptions options;
  options.listen = listen_.parse_options();
  options.listen.gather = gather_time;
  options.form = parse_form();
  options.file = file_text_;
  options.force = force_->count() > 0;
  if (file_->count() > 0 && (file_text_.empty() || file_text_ == "-")) {
    throw UsageError("-o: expected the name of a file, found " + quote(file_text_) +
                     "; `roio-cli dump --log` writes to standard output");
  }
  return options;
}

RecordOptions RecordWords::parse() const {
  refuse_rest(*app_, "record");
  RecordOptions options = parse_options();
  listen_.parse_words(options.listen);
  if (options.form == Form::pcap && options.listen.buses.size() > 1) {
    throw UsageError("--pcap: expected one BUS, as its form has no place for a bus's name");
  }
  return options;
}

}  // namespace roio::cli
