#include "record/play_window.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "record/log_disorder.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t second_digits = 10;
constexpr std::size_t nanosecond_digits = 9;
constexpr std::int64_t latest_s = 4'000'000'000;  // twice that is a Timestamp still

// Digits alone: no sign, no blank.
std::optional<std::int64_t> read_digits(std::string_view text, std::size_t most) {
  if (text.empty() || text.size() > most ||
      text.find_first_not_of("0123456789") != std::string_view::npos) {
    return std::nullopt;
  }
  std::int64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::optional<std::int64_t> read_fraction(std::string_view text) {
  auto value = read_digits(text, nanosecond_digits);
  for (std::size_t digits = text.size(); value && digits < nanosecond_digits; ++digits) {
    *value *= 10;
  }
  return value;
}

}  // namespace

Parsed<LogTime> parse_log_time(const std::string& text) {
  const bool since_first = text.starts_with('+');
  const std::string_view number = std::string_view(text).substr(since_first ? 1 : 0);
  const std::size_t dot = number.find('.');
  const auto seconds = read_digits(number.substr(0, dot), second_digits);
  const auto nanoseconds = dot == std::string_view::npos ? std::optional<std::int64_t>(0)
                                                         : read_fraction(number.substr(dot + 1));
  if (!seconds || !nanoseconds || *seconds > latest_s) {
    return ParseError{
        "expected a time as the log has it, such as 1436509052.25, or +12.5 since "
        "its first frame, found " +
            quote(text),
        0};
  }
  return LogTime{std::chrono::seconds(*seconds) + std::chrono::nanoseconds(*nanoseconds),
                 since_first};
}

PlayWindow::Place PlayWindow::place(std::optional<Timestamp> time) {
  if (!time) {
    return last_;
  }
  first_ = first_.value_or(*time);
  if (to_ && *time > absolute(*to_) + log_disorder) {
    last_ = Place::behind;
  } else if ((to_ && *time > absolute(*to_)) || (from_ && *time < absolute(*from_))) {
    last_ = Place::outside;
  } else {
    last_ = Place::inside;
  }
  return last_;
}

Timestamp PlayWindow::absolute(const LogTime& time) const {
  return time.since_first ? *first_ + time.time : Timestamp(time.time);
}

}  // namespace roio::cli
