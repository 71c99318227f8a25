#include "record/record.hpp"

#include <signal.h>

#include <chrono>
#include <optional>

#include "program/exit_status.hpp"
#include "program/output.hpp"
#include "record/progress.hpp"
#include "record/record_file.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

// What a killed record has not written is of less than two such times.
constexpr std::chrono::milliseconds write_every{100};
constexpr std::size_t write_at_bytes = 65536;

std::unique_ptr<RecordFormat> make_format(Form form) {
  switch (form) {
    case Form::csv:
      return csv_format();
    case Form::pcap:
      return pcap_format();
    default:
      return log_format();
  }
}

class Recorder final : public Hearer {
 public:
  Recorder(RecordFormat& format, RecordFile& file, const Listener& listener)
      : format_(format), file_(file), listener_(listener) {
    format_.begin(out_);
    write();  // a Wireshark that waits at the pipe begins with it
  }

  void frame(const Origin& from, const Received& received) override {
    format_.frame(out_, from, received);
    ++waiting_;
    if (out_.size() >= write_at_bytes) {
      write();
    }
  }

  void news(const Origin& from, const BusNews& news) override {
    if (!format_.news(out_, from, news)) {
      progress_.clear();
      note(from.bus + ": " + to_text(news));
    }
  }

  void settle(bool /*quiet*/) override {
    const auto now = Clock::now();
    if (out_.size() > 0 && now - last_written_ >= write_every) {
      write();
      last_written_ = now;
    }
    if (progress_.is_due(now)) {
      progress_.show(file_.name() + ": " + clock_text(now - start_) + ", " +
                         count_of(written_ + waiting_, "frame") + ", " +
                         std::to_string(listener_.lost()) + " lost",
                     now);
    }
  }

  void finish() {
    write();
    file_.close();
    progress_.clear();
  }

  [[nodiscard]] std::uint64_t written() const { return written_; }

 private:
  void write() {
    try {
      file_.write(out_);
    } catch (const Failure& failure) {
      throw Failure(std::string(failure.what()) + "; " + count_of(written_, "frame") +
                    " recorded before");
    }
    written_ += waiting_;
    waiting_ = 0;
  }

  RecordFormat& format_;
  RecordFile& file_;
  const Listener& listener_;
  Progress progress_;
  Buffer out_;
  std::uint64_t waiting_ = 0;  // frames in out_
  std::uint64_t written_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_written_;
};

std::string counts_text(std::uint64_t frames, std::uint64_t lost, std::uint64_t fd_frames) {
  return count_of(frames, "frame") + " recorded, " + std::to_string(lost) + " lost" +
         (fd_frames > 0 ? ", " + count_of(fd_frames, "CAN FD frame") + " left out" : "");
}

void say_counts(const Listener& listener, const RecordFile& file, std::uint64_t written) {
  const std::vector<Origin>& origins = listener.origins();
  std::uint64_t fd_frames = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    fd_frames += listener.fd_frames(i);
    if (origins.size() > 1) {
      note(origins[i].bus + ": " +
           counts_text(listener.frames(i), listener.lost(i), listener.fd_frames(i)));
    }
  }
  note(file.name() + ": " + counts_text(written, listener.lost(), fd_frames));
}

// A limit of a file's size is an error as a full disk is.
void ignore_size_signal() {
  struct sigaction action {};
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, nullptr);
}

}  // namespace

int record(const RecordOptions& options) {
  // Before a bus is opened, which may take seconds and restart a board.
  if (!options.file.empty() && !options.force) {
    RecordFile::refuse_existing(options.file);
  }
  ignore_size_signal();
  Listener listener(options.listen);
  auto file = options.file.empty() ? RecordFile::create_dated(options.form)
                                   : RecordFile::create(options.file, options.force);
  if (!file) {
    return listener.finish();
  }
  const auto format = make_format(options.form);
  Recorder recorder(*format, *file, listener);
  note(names_of(listener.origins()) + ": recording to " + file->name());
  listener.run(recorder);
  recorder.finish();
  say_counts(listener, *file, recorder.written());
  return listener.finish();
}

}  // namespace roio::cli
