#include "top/terminal.hpp"

#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "program/exit_status.hpp"
#include "program/interrupt.hpp"

namespace roio::cli {
namespace {

// Another screen, no cursor, no line that goes on in the next.
constexpr std::string_view enter_text = "\033[?1049h\033[?25l\033[?7l\033[2J";
constexpr std::string_view leave_text = "\033[0m\033[?7h\033[?25h\033[?1049l";

// What a terminal takes at once where it says that there is room (a quarter of what Linux's says).
constexpr std::size_t chunk_size = 64;

// How long a terminal that takes nothing may keep the program from its end.
constexpr int leave_ms = 200;

// All that a signal handler can reach.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<bool> stop_asked{false};
std::atomic<bool> resized_or_continued{false};
std::atomic<bool> continued{false};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

extern "C" void on_terminal_signal(int number) {
  if (number == SIGTSTP) {
    stop_asked = true;
  } else {
    resized_or_continued = true;
    continued = continued || number == SIGCONT;
  }
  Interrupt::wake();
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);  // no SA_RESTART: a wait is to end by it
}

// As if nobody had caught Ctrl-Z: who has no shell to go on from is not stopped, then.
void stop() {
  handle(SIGTSTP, SIG_DFL);
  static_cast<void>(::raise(SIGTSTP));
  handle(SIGTSTP, on_terminal_signal);
}

bool cannot_be_drawn_on() {
  const char* const term = std::getenv("TERM");
  return term == nullptr || *term == '\0' || std::string_view(term) == "dumb";
}

}  // namespace

bool output_is_terminal() noexcept {
  return ::isatty(STDOUT_FILENO) == 1;
}

Terminal::Terminal() {
  if (cannot_be_drawn_on()) {
    throw UsageError(
        "this terminal cannot be drawn on (TERM is not set, or dumb); with --json, or into a pipe, "
        "top writes lines");
  }
  has_keys_ = ::tcgetattr(STDIN_FILENO, &before_) == 0;
  Interrupt::also(SIGHUP);
  Interrupt::also(SIGQUIT);
  for (const int number : {SIGWINCH, SIGTSTP, SIGCONT}) {
    handle(number, on_terminal_signal);
  }
  enter();
}

Terminal::~Terminal() {
  leave();
  for (const int number : {SIGWINCH, SIGTSTP, SIGCONT}) {
    handle(number, SIG_DFL);
  }
}

// Keys come at once and do not show. Ctrl-C and Ctrl-Z stay signals; Ctrl-S is a key like another,
// as it would stop the drawing.
void Terminal::enter() {
  if (has_keys_) {
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_iflag &= ~static_cast<tcflag_t>(IXON);
    keys.c_cc[VMIN] = 0;
    keys.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  }
  shown_.clear();
  pending_ = enter_text;
  entered_ = true;
}

void Terminal::leave() {
  if (!std::exchange(entered_, false)) {
    return;
  }
  // The rest of a screen is left out; CAN ends what it may have broken off.
  pending_ = pending_.empty() ? "" : "\030";
  pending_ += leave_text;
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  while (!pending_.empty() && !gone_ && ::poll(&out, 1, leave_ms) == 1) {
    write_on();
  }
  if (has_keys_) {
    ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
}

Size Terminal::size() {
  winsize window{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0 ||
      window.ws_row == 0) {
    return {};
  }
  return {window.ws_col, window.ws_row};
}

void Terminal::show(const std::vector<std::string>& lines) {
  const Size now = size();
  const bool anew =
      shown_.empty() || now.columns != shown_size_.columns || now.lines != shown_size_.lines;
  if (!pending_.empty() && !shown_.empty()) {
    return;
  }
  pending_ += anew ? "\033[2J" : "";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (anew || i >= shown_.size() || lines[i] != shown_[i]) {
      // First away with what is there: at the end of a full line that would take its last letter.
      pending_ += "\033[" + std::to_string(i + 1) + ";1H\033[2K" + lines[i];
    }
  }
  shown_ = lines;
  shown_size_ = now;
}

pollfd Terminal::input() const {
  return {has_keys_ ? STDIN_FILENO : -1, POLLIN, 0};
}

pollfd Terminal::output() const {
  return {STDOUT_FILENO, pending_.empty() ? short{0} : short{POLLOUT}, 0};
}

void Terminal::write_on() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  while (!pending_.empty() && ::poll(&out, 1, 0) == 1) {
    const ssize_t written =
        ::write(STDOUT_FILENO, pending_.data(), std::min(pending_.size(), chunk_size));
    if (written > 0) {
      pending_.erase(0, static_cast<std::size_t>(written));
    } else if (errno != EINTR && errno != EAGAIN) {
      gone_ = true;
      return;
    }
  }
}

std::optional<std::string> Terminal::read() {
  std::array<char, 256> bytes;
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count > 0) {
    return std::string(bytes.data(), static_cast<std::size_t>(count));
  }
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) {
    return "";
  }
  return std::nullopt;  // it was readable, and there is nothing
}

bool Terminal::changed() {
  if (stop_asked.exchange(false)) {
    leave();
    stop();
    continued = true;
  }
  // What has come meanwhile may end the program: then the terminal stays as it is.
  if (continued.exchange(false) && Interrupt::signal() == 0) {
    enter();
    resized_or_continued = true;
  }
  return resized_or_continued.exchange(false);
}

}  // namespace roio::cli
