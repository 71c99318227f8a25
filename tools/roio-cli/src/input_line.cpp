#include "input_line.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <roio/candump_log.hpp>
#include <roio/message.hpp>
#include <system_error>

#include "exit_status.hpp"
#include "json_lines.hpp"

namespace roio::cli {
namespace {

constexpr std::string_view white_space = " \t\r\n";

Parsed<Frame> from_json(std::string_view line, Address default_source) {
  const auto json = parse_json_line(line);
  if (!json) {
    return json.error();
  }
  Message message = json->message;
  if (!json->has_source) {
    message.header.source = default_source;
  }
  Frame frame{};
  if (to_frame(message, frame) != Status::ok) {
    return ParseError{"expected a message of class message, system or stream", 0};
  }
  return frame;
}

Parsed<Frame> from_log(std::string_view line) {
  const auto log = parse_log_line(line);
  if (!log) {
    return log.error();
  }
  if (log->frame.kind == FrameKind::error) {
    return ParseError{"expected a frame to send, found a controller's error report", 0};
  }
  return log->frame;
}

}  // namespace

bool is_blank(std::string_view line) noexcept {
  return line.find_first_not_of(white_space) == std::string_view::npos;
}

Parsed<Frame> parse_input_line(std::string_view line, Address default_source) {
  if (line.size() > LineReader::max_line) {
    return ParseError{
        "expected a line of at most " + std::to_string(LineReader::max_line) + " bytes", 0};
  }
  const std::size_t first = line.find_first_not_of(white_space);
  if (first != std::string_view::npos && line[first] == '{') {
    return from_json(line, default_source);
  }
  if (first != std::string_view::npos && line[first] == '(') {
    return from_log(line.substr(first));
  }
  return ParseError{
      "expected a JSON message {\"type\":\"Roio\",...} or a line of a log "
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
    throw Failure("standard input: " + std::generic_category().message(errno));
  }
  if (count > 0) {
    text_.append(more.data(), static_cast<std::size_t>(count));
  }
  at_end_ = count == 0;
  return !at_end_;
}

}  // namespace roio::cli
