// Source: can-utils 2020.11 candump.c, whose line is printf("(%010lu.%06lu) %*s %s%s\n"), and
// canplayer.c, which scans "(%lu.%lu) %s %s".
#include <algorithm>
#include <cstring>
#include <roio/candump_log.hpp>

#include "text/decimal.hpp"
#include "text/frame_text.hpp"
#include "text/quote.hpp"
#include "text/seconds.hpp"

namespace roio {
namespace {

constexpr std::uint64_t us_per_s = 1000000;
constexpr std::size_t second_digits = 10;
constexpr std::size_t microsecond_digits = 6;

static_assert(max_log_line == 1 + second_digits + 1 + microsecond_digits + 2 + max_log_name + 1 +
                                  max_frame_text + 1,
              "(seconds.microseconds) name frame\\n");

bool is_blank(char character) {
  return character == ' ' || character == '\t';
}

// A line read from left to right, word by word.
class Cursor {
 public:
  explicit Cursor(std::string_view line) : line_(line) {}

  [[nodiscard]] std::size_t offset() const { return at_; }

  std::string_view word() {
    const std::size_t start = at_;
    while (at_ < line_.size() && !is_blank(line_[at_])) {
      ++at_;
    }
    return line_.substr(start, at_ - start);
  }

  /// The same, but blanks before the mark do not end it.
  std::string_view word_through(char mark) {
    const std::size_t start = at_;
    const std::size_t found = line_.find(mark, at_);
    at_ = found == std::string_view::npos ? at_ : found;
    word();
    return line_.substr(start, at_ - start);
  }

  void skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) {
      ++at_;
    }
  }

 private:
  std::string_view line_;
  std::size_t at_ = 0;
};

std::string_view without_line_end(std::string_view line) {
  if (line.ends_with('\n')) {
    line.remove_suffix(1);
  }
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

Parsed<Timestamp> read_time(std::string_view word) {
  if (!word.starts_with('(')) {
    return ParseError{"no '(' at its start; expected (SECONDS.FRACTION) INTERFACE FRAME", 0};
  }
  const std::size_t close = word.find(')');
  if (close == std::string_view::npos) {
    return ParseError{"no ')' after the time; expected (SECONDS.FRACTION)", word.size()};
  }
  if (close + 1 != word.size()) {
    return ParseError{quote(word.substr(close + 1)) + " after the time; expected a space",
                      close + 1};
  }
  const std::string_view time = word.substr(1, close - 1);
  const std::size_t dot = std::min(time.find('.'), time.size());
  const std::string_view seconds = time.substr(0, dot);
  const std::string_view fraction = time.substr(std::min(dot + 1, time.size()));
  if (!is_digits(seconds) || !is_digits(fraction) || fraction.size() > 9) {
    return ParseError{
        "time " + quote(time) + "; expected seconds, a dot and 1..9 digits, such as 0.250000", 1};
  }
  const auto timestamp = read_seconds(seconds, fraction);
  if (!timestamp) {
    return ParseError{
        "time " + quote(time) + " is out of range; expected at most " + latest_time + " s", 1};
  }
  return *timestamp;
}

bool is_bracketed(std::string_view word) {
  return word.starts_with('(') && word.ends_with(')');
}

bool is_control(char character) {
  return static_cast<unsigned char>(character) < ' ' || character == '\x7F';
}

std::optional<ParseError> check_name(std::string_view name, std::size_t offset) {
  if (name.empty()) {
    return ParseError{"no interface; expected (SECONDS.FRACTION) INTERFACE FRAME", offset};
  }
  if (name.size() > max_log_name) {
    return ParseError{"an interface name of " + std::to_string(name.size()) +
                          " bytes; expected at most " + std::to_string(max_log_name),
                      offset};
  }
  const auto bad = std::find_if(name.begin(), name.end(), is_control);
  if (bad != name.end()) {
    return ParseError{"a control character in the interface name",
                      offset + static_cast<std::size_t>(bad - name.begin())};
  }
  return std::nullopt;
}

Parsed<Frame> read_log_frame(std::string_view word, std::size_t offset) {
  if (word.empty()) {
    return ParseError{"no frame; expected (SECONDS.FRACTION) INTERFACE FRAME", offset};
  }
  Parsed<Frame> frame = in_context("frame", word, read_frame(word));
  if (!frame) {
    return ParseError{frame.error().message, offset + frame.error().offset};
  }
  return frame;
}

// Nothing, or the direction that candump -x and canplayer know.
std::optional<ParseError> check_rest(Cursor cursor) {
  const std::size_t offset = cursor.offset();
  const std::string_view mark = cursor.word();
  cursor.skip_blanks();
  const std::string_view more = cursor.word();
  if ((mark.empty() || mark == "R" || mark == "T") && more.empty()) {
    return std::nullopt;
  }
  return ParseError{quote(more.empty() ? mark : more) + " after the frame; expected nothing more",
                    more.empty() ? offset : cursor.offset() - more.size()};
}

enum class TimeWanted : bool { no, yes };

Parsed<LogLine> read_log_line(std::string_view line, TimeWanted wanted) {
  if (line.empty()) {
    return ParseError{"empty; expected (SECONDS.FRACTION) INTERFACE FRAME", 0};
  }
  Cursor cursor(line);
  const std::string_view brackets =
      wanted == TimeWanted::yes ? cursor.word() : cursor.word_through(')');
  const Parsed<Timestamp> time = read_time(brackets);
  if (!time && (wanted == TimeWanted::yes || !is_bracketed(brackets))) {
    return time.error();
  }
  cursor.skip_blanks();
  const std::size_t name_offset = cursor.offset();
  const std::string_view name = cursor.word();
  if (const auto error = check_name(name, name_offset)) {
    return *error;
  }
  cursor.skip_blanks();
  const std::size_t frame_offset = cursor.offset();
  const Parsed<Frame> frame = read_log_frame(cursor.word(), frame_offset);
  if (!frame) {
    return frame.error();
  }
  cursor.skip_blanks();
  if (const auto error = check_rest(cursor)) {
    return *error;
  }
  return LogLine{time ? *time : Timestamp{}, std::string(name), *frame};
}

char* write_time(char* out, Timestamp time) noexcept {
  const std::uint64_t us = microseconds(time);
  *out++ = '(';
  out = write_decimal(out, us / us_per_s, second_digits);
  *out++ = '.';
  out = write_decimal(out, us % us_per_s, microsecond_digits);
  *out++ = ')';
  return out;
}

}  // namespace

Parsed<LogLine> parse_log_line(std::string_view line) {
  line = without_line_end(line);
  return in_context("log line", line, read_log_line(line, TimeWanted::yes));
}

Parsed<LogLine> parse_log_line_of_any_time(std::string_view line) {
  line = without_line_end(line);
  return in_context("log line", line, read_log_line(line, TimeWanted::no));
}

std::size_t format_log_line(std::span<char, max_log_line> out, Timestamp time,
                            std::string_view interface_name, const Frame& frame) noexcept {
  char* end = write_time(out.data(), time);
  *end++ = ' ';
  const std::size_t name_length = std::min(interface_name.size(), max_log_name);
  if (name_length > 0) {
    std::memcpy(end, interface_name.data(), name_length);
    end += name_length;
  }
  *end++ = ' ';
  end = write_frame(end, frame);
  *end++ = '\n';
  return static_cast<std::size_t>(end - out.data());
}

}  // namespace roio
