#include "top/facts.hpp"

#include <fmt/format.h>

#include "form/record_format.hpp"
#include "top/line.hpp"

namespace roio::cli {
namespace {

Line bus_line(const Snapshot& snapshot, bool paused, std::size_t columns, bool colour) {
  Line line(columns, colour);
  line.add(snapshot.bus, Style::strong);
  line.add("  ");
  line.add(to_string(snapshot.state),
           snapshot.state == BusState::active ? Style::plain : Style::warning);
  if (paused) {
    line.add("  ");
    line.add("PAUSED", Style::warning);
  }
  if (snapshot.bitrate_bps) {
    line.add(fmt::format("  {} bit/s", *snapshot.bitrate_bps));
  }
  return line;
}

Line load_line(const Snapshot& snapshot, std::size_t columns, bool colour) {
  constexpr double percent = 100;
  Line line(columns, colour);
  const Load& load = snapshot.load;
  if (load.share && load.peak_share) {
    line.add("load ");
    line.add(fmt::format("{:5.1f} %", *load.share * percent), Style::strong);
    line.add(fmt::format(", peak {:5.1f} %", *load.peak_share * percent));
    line.add(fmt::format(", {:.0f} frames/s, {:.0f} bit/s", load.frames_per_s, load.bits_per_s));
  } else {
    line.add(fmt::format("{:.0f} frames/s, {:.0f} bit/s, peak {:.0f} bit/s", load.frames_per_s,
                         load.bits_per_s, load.peak_bits_per_s));
    line.add("; load: see --bitrate", Style::dim);
  }
  return line;
}

Line count_line(const Snapshot& snapshot, std::size_t columns, bool colour) {
  Line line(columns, colour);
  const auto add = [&](std::uint64_t count, const std::string& text) {
    line.add(", ");
    line.add(text, count > 0 ? Style::warning : Style::plain);
  };
  line.add(count_of(snapshot.frames, "frame"));
  add(snapshot.lost, fmt::format("{} lost", snapshot.lost));
  if (snapshot.rowless > 0) {
    add(snapshot.rowless, fmt::format("{} without a row", snapshot.rowless));
  }
  if (snapshot.overruns > 0) {
    add(snapshot.overruns, "the controller lost some " + count_of(snapshot.overruns, "time"));
  }
  add(snapshot.errors, count_of(snapshot.errors, "error"));
  add(snapshot.bus_offs, fmt::format("{} bus-off", count_of(snapshot.bus_offs, "time")));
  add(snapshot.outages, count_of(snapshot.outages, "outage"));
  if (snapshot.fd_frames > 0) {
    add(snapshot.fd_frames, fd_frames_not_shown(snapshot.fd_frames));
  }
  return line;
}

}  // namespace

std::vector<std::string> fact_lines(const Snapshot& snapshot, bool paused, std::size_t columns,
                                    bool colour) {
  return {bus_line(snapshot, paused, columns, colour).text(),
          load_line(snapshot, columns, colour).text(),
          count_line(snapshot, columns, colour).text()};
}

}  // namespace roio::cli
