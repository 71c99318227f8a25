#include "record/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace roio::cli {
namespace {

constexpr std::chrono::seconds show_every{1};

void write_error(const std::string& text) {
  // Nobody is left to tell when standard error fails.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

Progress::Progress()
    : on_terminal_(::isatty(STDERR_FILENO) == 1), next_(Clock::now() + show_every) {}

void Progress::show(const std::string& text, Clock::time_point now) {
  write_error("\r\033[K" + text);
  is_shown_ = true;
  next_ = now + show_every;
}

void Progress::clear() {
  if (is_shown_) {
    write_error("\r\033[K");
    is_shown_ = false;
  }
}

std::string clock_text(std::chrono::nanoseconds time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time).count();
  return fmt::format("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

}  // namespace roio::cli
