/// SIGINT and SIGTERM end a command cleanly: its waits return, it finishes its line and says its
/// last word. A second one kills. SIGPIPE is left to write(), which reports it.
#ifndef ROIO_CLI_INTERRUPT_HPP
#define ROIO_CLI_INTERRUPT_HPP

#include <poll.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <roio/bus.hpp>
#include <span>
#include <string>

namespace roio::cli {

/// One at a time; from its construction on, signals are caught.
class Interrupt {
 public:
  Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  ~Interrupt();

  /// The signal that came, or 0.
  [[nodiscard]] static int signal() noexcept;

  /// Waits until `until`.
  /// @return false when a signal ended the wait.
  [[nodiscard]] static bool sleep_until(std::chrono::steady_clock::time_point until);

  /// From now on this signal ends the command, too, unless it is ignored, as `nohup` has it.
  static void also(int number);

  /// Waits as poll() does, at most until `until`; another signal's handler ends the wait, too.
  /// @param fds their revents are set, or 0.
  /// @return false when a signal that ends the command ended the wait.
  [[nodiscard]] static bool wait(std::span<pollfd> fds,
                                 std::chrono::steady_clock::time_point until);

  /// Ends the wait() that is going on, or the next one: for another signal's handler, so that what
  /// it has set is looked at also when it came just before the wait.
  static void wake() noexcept;

  /// Waits without limit until fd can be read (or is at its end).
  /// @return false when a signal ended the wait.
  [[nodiscard]] static bool wait_readable(int fd);

  /// Waits until one of them can be read, for at most so long.
  /// @return false when the time has passed or a signal came.
  [[nodiscard]] static bool wait_readable(std::span<const int> fds,
                                          std::chrono::nanoseconds timeout);
};

/// Opens a bus. A signal meanwhile ends the process at once, with 128 and its number: open() may
/// wait for seconds, and nothing has been sent or shown yet.
std::unique_ptr<Bus> open_until_signal(const std::string& url, const OpenOptions& options = {});

/// While it lives, a signal also cancels the waits of a bus.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Bus& bus) noexcept;
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
  ~CancelOnSignal();
};

}  // namespace roio::cli

#endif
