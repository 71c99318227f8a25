#include "bridge/report.hpp"

#include <fmt/format.h>

#include <iterator>
#include <roio/text.hpp>

#include "bridge/counts.hpp"

namespace roio::cli {
namespace {

void append_counts(Buffer& out, const char* heading, std::span<const Count> counts) {
  fmt::format_to(std::back_inserter(out), "{}\n", heading);
  for (const Count& count : counts) {
    fmt::format_to(std::back_inserter(out), "  {:<50} {}\n", count.label, count.value);
  }
}

void append_fact(Buffer& out, const char* name, const std::string& value) {
  fmt::format_to(std::back_inserter(out), "  {:<12} {}\n", name, value);
}

/// What the crystal makes is said where it is not what was asked for.
std::string bitrate_text(const BridgeInfo& info) {
  return info.real_bitrate_bps == 0 || info.real_bitrate_bps == info.bitrate_bps
             ? fmt::format("{} bit/s", info.bitrate_bps)
             : fmt::format("{} bit/s: {} is what the crystal makes", info.bitrate_bps,
                           info.real_bitrate_bps);
}

std::string crystal(const BridgeInfo& info) {
  return info.osc_khz == 0 ? "unknown, as no controller answers"
                           : fmt::format("{:g} MHz", info.osc_khz / 1000.0);
}

}  // namespace

void append_text(Buffer& out, const BridgeReport& report) {
  const BridgeInfo& info = report.info;
  fmt::format_to(std::back_inserter(out), "{}: {}, firmware {}\n", info.port, to_string(info.board),
                 to_string(info.firmware));
  append_fact(out, "bit rate", bitrate_text(info));
  append_fact(out, "mode", to_string(info.mode));
  append_fact(out, "state",
              fmt::format("{}, error counters: transmit {}, receive {}", to_string(info.state),
                          info.transmit_errors, info.receive_errors));
  append_fact(out, "address", info.address ? to_string(*info.address) : "none");
  append_fact(out, "crystal", crystal(info));
  append_fact(out, "INT line", info.interrupt_wired ? "wired" : "not wired, which makes it slower");
  append_fact(out, "serial line",
              info.line_rate_matters ? fmt::format("{} bit/s", info.line_rate_bps) : "USB");
  append_counts(out,
                "from the bus to this computer, since the board's reset:", counts_up(report.board));
  append_counts(
      out, "from this computer to the bus, since the board's reset:", counts_down(report.board));
  append_counts(out,
                "the controller, since the board's reset:", counts_of_controller(report.board));
  append_counts(out, "the serial line, since it was opened just now:", counts_of_line(report.line));
}

void append_text(Buffer& out, const BusReport& report, std::size_t width) {
  std::string what = report.kind == "can"     ? "CAN interface"
                     : report.kind == "local" ? "local bus"
                                              : "bridge";
  if (report.interface_kind && *report.interface_kind != "can") {
    what += " (" + *report.interface_kind + ")";
  }
  for (const auto& fact : {report.board, report.state}) {
    what += fact ? ", " + *fact : "";
  }
  if (report.firmware) {
    what += ", firmware " + *report.firmware;
  }
  if (report.bitrate_bps) {
    what += fmt::format(", {} bit/s", *report.bitrate_bps);
  }
  if (report.why_not) {
    what = "no bridge: " + *report.why_not;
    what += report.product ? " (" + *report.product + ")" : "";
  }
  fmt::format_to(std::back_inserter(out), "{:<{}}  {}\n", report.bus, width, what);
}

}  // namespace roio::cli
