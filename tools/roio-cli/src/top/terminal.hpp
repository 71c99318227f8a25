/// Terminal: standard output as a screen of its own, and standard input as keys. What was there
/// comes back when it goes, whatever the reason; also while the program is stopped (Ctrl-Z).
#ifndef ROIO_CLI_TERMINAL_HPP
#define ROIO_CLI_TERMINAL_HPP

#include <poll.h>
#include <termios.h>

#include <optional>
#include <string>
#include <vector>

#include "top/view.hpp"

namespace roio::cli {

/// Whether standard output is a terminal.
bool output_is_terminal() noexcept;

class Terminal {
 public:
  /// @throws UsageError: a terminal that cannot be drawn on (TERM=dumb).
  Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal();

  /// As it is now; 80x24 where it does not say.
  [[nodiscard]] static Size size();

  /// Shows these lines, from the top. Never waits: while an older screen has not gone out yet, this
  /// one is left out.
  void show(const std::vector<std::string>& lines);

  /// What to poll for: keys, and room for what is still to go out. -1: not now.
  [[nodiscard]] pollfd input() const;
  [[nodiscard]] pollfd output() const;
  /// Goes on with what has not gone out yet.
  void write_on();
  /// The keys that were pressed. None: nobody is there any more.
  static std::optional<std::string> read();
  [[nodiscard]] bool gone() const { return gone_; }

  /// Whether something has happened after which all is to be drawn anew: another size, or the
  /// program was stopped and goes on. A Ctrl-Z stops it in here.
  bool changed();

 private:
  void enter();
  void leave();

  termios before_{};
  bool has_keys_ = false;
  std::vector<std::string> shown_;  // what stands there now
  Size shown_size_{0, 0};
  std::string pending_;  // has not gone out yet
  bool gone_ = false;
  bool entered_ = false;
};

}  // namespace roio::cli

#endif
