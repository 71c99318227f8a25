#include "dump/dump.hpp"

#include <signal.h>
#include <unistd.h>

#include <memory>

#include "names/robot_labels.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

std::unique_ptr<RecordFormat> make_text_format(const DumpOptions& options,
                                               const std::vector<Origin>& origins) {
  TextStyle style;
  style.time = options.time;
  style.bus_width = origins.size() > 1 ? width_of(origins) : 0;
  if (wants_colour()) {
    style.colour = options.colour_sources ? Colour::sources : Colour::kinds;
  }
  style.labels = labels_of(options.listen.robot, options.bytes_only);
  return text_format(style);
}

std::unique_ptr<RecordFormat> make_format(const DumpOptions& options,
                                          const std::vector<Origin>& origins) {
  switch (options.form) {
    case Form::log:
      return log_format();
    case Form::json:
      return json_format(origins.size() > 1, options.listen.robot);
    case Form::csv:
      return csv_format();
    case Form::pcap:
      return pcap_format();
    case Form::text:
      break;
  }
  return make_text_format(options, origins);
}

class Dump final : public Hearer {
 public:
  Dump(RecordFormat& format) : format_(format) {
    format_.begin(out_);
    flush(out_);  // a Wireshark that waits at the pipe begins with it
  }

  void frame(const Origin& from, const Received& received) override {
    format_.frame(out_, from, received);
  }

  // Before what goes to standard error, what came before it goes out: both streams together stay in
  // order.
  void news(const Origin& from, const BusNews& news) override {
    if (!format_.news(out_, from, news)) {
      flush(out_);
      note(from.bus + ": " + to_text(news));
    }
  }

  void settle(bool quiet) override {
    flush(out_);
    if (quiet && output_is_gone()) {
      throw BrokenPipe{};
    }
  }

 private:
  RecordFormat& format_;
  Buffer out_;
};

void say_counts(const Listener& listener, bool verbose) {
  for (std::size_t i = 0; i < listener.origins().size(); ++i) {
    const std::uint64_t lost = listener.lost(i);
    const std::uint64_t fd_frames = listener.fd_frames(i);
    if (lost > 0 || fd_frames > 0 || verbose) {
      note(listener.origins()[i].bus + ": " + count_of(listener.frames(i), "frame") + " shown, " +
           std::to_string(lost) + " lost" +
           (fd_frames > 0 ? ", " + fd_frames_not_shown(fd_frames) : ""));
    }
  }
}

}  // namespace

int dump(const DumpOptions& options) {
  if (options.form == Form::pcap && ::isatty(STDOUT_FILENO) == 1) {
    throw UsageError("--pcap: expected into a file or a pipe, as what it writes is no text");
  }
  Listener listener(options.listen);
  const auto format = make_format(options, listener.origins());
  Dump shown(*format);
  if (options.verbose) {
    note(names_of(listener.origins()) + ": listening");
  }
  try {
    listener.run(shown);
  } catch (const Failure&) {
    // A terminal that has gone takes no last lines.
    if (Interrupt::signal() != SIGHUP) {
      throw;
    }
  }
  say_counts(listener, options.verbose);
  return listener.finish();
}

}  // namespace roio::cli
