#include "form/input_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <roio/candump_log.hpp>
#include <system_error>

#include "form/json_lines.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {
namespace {

constexpr std::string_view white_space = " \t\r\n";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// What candump -l writes between the frames, with -d.
constexpr std::string_view drops_of_candump = "DROPCOUNT: ";

InputLine of_kind(InputLine::Kind kind) {
  return {kind, {}, {}};
}

// An error report is none to be sent.
InputLine line_of(const Frame& frame) {
  return frame.kind == FrameKind::error ? of_kind(InputLine::Kind::news)
                                        : InputLine{InputLine::Kind::frame, frame};
}

Parsed<InputLine> from_json(std::string_view line, Address default_source, const Robot* robot) {
  const auto frame = parse_json_line(line, default_source, robot);
  if (!frame) {
    return frame.error();
  }
  if (!*frame) {
    return of_kind(InputLine::Kind::news);
  }
  InputLine read = line_of((*frame)->frame);
  read.time = (*frame)->time;
  read.interface_name = (*frame)->bus;
  return read;
}

Parsed<InputLine> from_log(std::string_view text) {
  const auto timed = parse_log_line(text);
  const auto log = timed ? timed : parse_log_line_of_any_time(text);
  if (!log) {
    return log.error();
  }
  InputLine line = line_of(log->frame);
  line.interface_name = log->interface_name;
  line.time = timed ? std::optional(timed->time) : std::nullopt;
  return line;
}

Parsed<InputLine> from_frame(std::string_view text) {
  const auto frame = parse_frame_text(text);
  if (!frame) {
    return frame.error();
  }
  return line_of(*frame);
}

bool is_comment(std::string_view text) {
  return text.starts_with('#') || text.starts_with(';') || text.starts_with("//");
}

// What is wrong with a line of any kind. A zero byte ends a text for some parsers, which then take
// what stands before it.
std::optional<ParseError> check_line(std::string_view line) {
  if (line.size() > LineReader::max_line) {
    return ParseError{
        "expected a line of at most " + std::to_string(LineReader::max_line) + " bytes", 0};
  }
  const std::size_t zero = line.find('\0');
  if (zero != std::string_view::npos) {
    return ParseError{"a zero byte at byte " + std::to_string(zero) + "; expected text", zero};
  }
  if (line.starts_with(byte_order_mark)) {
    return ParseError{"begins with a byte order mark; expected text without one", 0};
  }
  return std::nullopt;
}

}  // namespace

bool is_blank(std::string_view line) noexcept {
  return line.find_first_not_of(white_space) == std::string_view::npos;
}

Parsed<InputLine> parse_input_line(std::string_view line, Address default_source,
                                   const Robot* robot) {
  if (const auto error = check_line(line)) {
    return *error;
  }
  const std::size_t first = std::min(line.find_first_not_of(white_space), line.size());
  const std::string_view text = line.substr(first, line.find_last_not_of(white_space) + 1 - first);
  if (text.starts_with('{')) {
    return from_json(line, default_source, robot);
  }
  if (text.starts_with('(')) {
    return from_log(text);
  }
  if (is_comment(text)) {
    return of_kind(InputLine::Kind::comment);
  }
  if (text.starts_with(drops_of_candump)) {
    return of_kind(InputLine::Kind::news);
  }
  if (text.find('#') != std::string_view::npos) {
    return from_frame(text);
  }
  return ParseError{
      "expected a JSON message {\"type\":\"Roio\",...}, a frame ID#DATA, or a line of a log "
      "\"(TIME) BUS ID#DATA\"",
      0};
}

std::optional<std::string_view> LineReader::next() {
  for (;;) {
    const std::string_view left = std::string_view(text_).substr(begin_);
    const std::size_t end = left.find('\n');
    if (end == std::string_view::npos && !(at_end_ && !left.empty())) {
      if (skipping_ || left.size() <= max_line) {
        return std::nullopt;
      }
      skipping_ = true;
      begin_ = text_.size();
      return left;  // too long, as its size says
    }
    begin_ = end == std::string_view::npos ? text_.size() : begin_ + end + 1;
    if (!skipping_) {
      return left.substr(0, end);
    }
    skipping_ = false;
  }
}

bool LineReader::fill() {
  if (skipping_) {
    begin_ = text_.size();
  }
  text_.erase(0, begin_);
  begin_ = 0;
  std::array<char, 16384> more;
  const ssize_t count = ::read(fd_, more.data(), more.size());
  if (count < 0 && errno != EINTR && errno != EAGAIN) {
    throw Failure(name_ + ": " + std::generic_category().message(errno));
  }
  if (count > 0) {
    text_.append(more.data(), static_cast<std::size_t>(count));
  }
  at_end_ = count == 0;
  return !at_end_;
}

}  // namespace roio::cli
