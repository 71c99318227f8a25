/// One line on standard error that changes in its place, where that is a terminal.
#ifndef ROIO_CLI_PROGRESS_HPP
#define ROIO_CLI_PROGRESS_HPP

#include <chrono>
#include <string>

namespace roio::cli {

class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { clear(); }

  /// Whether it is time for show(): once a second, and never where there is no terminal.
  [[nodiscard]] bool is_due(Clock::time_point now) const { return on_terminal_ && now >= next_; }
  /// When it will be; Clock::time_point::max() where there is no terminal.
  [[nodiscard]] Clock::time_point next() const {
    return on_terminal_ ? next_ : Clock::time_point::max();
  }
  void show(const std::string& text, Clock::time_point now);
  /// Takes the line away, for another that stays.
  void clear();

 private:
  bool on_terminal_;
  bool is_shown_ = false;
  Clock::time_point next_;
};

/// "0:00:12", "27:46:40".
std::string clock_text(std::chrono::nanoseconds time);

}  // namespace roio::cli

#endif
