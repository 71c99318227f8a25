#include "form/record_format.hpp"

#include <array>
#include <roio/candump_log.hpp>
#include <utility>

#include "program/output.hpp"

namespace roio::cli {
namespace {

class TextFormat final : public RecordFormat {
 public:
  TextFormat(TimeColumn::Mode time, bool colour) : time_(time), colour_(colour) {}

  void frame(Buffer& out, const Received& received) override {
    time_.append(out, received.time);
    append_frame(out, received.frame, colour_, time_.gap());
    out.push_back('\n');
  }
  void lost(Buffer& out, std::uint64_t count) override {
    announce(out, count_of(count, "frame") + " lost");
  }
  void not_shown(Buffer& out, std::uint64_t fd_frames) override {
    announce(out, fd_frames_not_shown(fd_frames));
  }
  void state(Buffer& out, BusState state) override {
    announce(out, std::string("bus is ") + to_string(state));
  }

 private:
  void announce(Buffer& out, const std::string& what) const {
    const std::string line = colour_ ? "\033[1;31m! " + what + "\033[0m" : "! " + what;
    out.append(line.data(), line.data() + line.size());
    out.push_back('\n');
  }

  TimeColumn time_;
  bool colour_;
};

class LogFormat final : public RecordFormat {
 public:
  explicit LogFormat(std::string interface_name) : interface_name_(std::move(interface_name)) {}

  void frame(Buffer& out, const Received& received) override {
    std::array<char, max_log_line> line;
    const std::size_t length =
        format_log_line(line, received.time, interface_name_, received.frame);
    out.append(line.data(), line.data() + length);
  }
  void lost(Buffer& out, std::uint64_t count) override {
    announce(out, count_of(count, "frame") + " lost");
  }
  void not_shown(Buffer& out, std::uint64_t fd_frames) override {
    announce(out, fd_frames_not_shown(fd_frames));
  }
  void state(Buffer& out, BusState state) override {
    announce(out, std::string("bus is ") + to_string(state));
  }

 private:
  // What came before goes out first, so that both streams together stay in order.
  void announce(Buffer& out, const std::string& what) const {
    flush(out);
    note(interface_name_ + ": " + what);
  }

  std::string interface_name_;
};

}  // namespace

std::unique_ptr<RecordFormat> text_format(TimeColumn::Mode time, bool colour) {
  return std::make_unique<TextFormat>(time, colour);
}

std::unique_ptr<RecordFormat> log_format(std::string interface_name) {
  return std::make_unique<LogFormat>(std::move(interface_name));
}

std::string count_of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string fd_frames_not_shown(std::uint64_t count) {
  return count_of(count, "CAN FD frame") + " not shown";
}

}  // namespace roio::cli
