#include "program/output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "program/exit_status.hpp"

namespace roio::cli {

void flush(Buffer& out) {
  std::string_view left(out.data(), out.size());
  while (!left.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, left.data(), left.size());
    if (written >= 0) {
      left.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EPIPE) {
      throw BrokenPipe{};
    } else if (errno == EAGAIN) {
      pollfd writable{STDOUT_FILENO, POLLOUT, 0};
      ::poll(&writable, 1, -1);
    } else if (errno != EINTR) {  // lines are finished even when a signal came
      throw Failure("standard output: " + std::generic_category().message(errno));
    }
  }
  out.clear();
}

bool output_is_gone() noexcept {
  pollfd output{STDOUT_FILENO, 0, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
}

bool wants_colour() noexcept {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool refused = no_color != nullptr && *no_color != '\0';
  const bool dumb = term != nullptr && std::string_view(term) == "dumb";
  return !refused && !dumb && ::isatty(STDOUT_FILENO) == 1;
}

void note(std::string_view text) noexcept {
  tell("roio-cli", text);
}

void tell(std::string_view tool, std::string_view text) noexcept {
  const std::string line = std::string(tool) + ": " + std::string(text) + '\n';
  // Nobody is left to tell when standard error fails.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace roio::cli
