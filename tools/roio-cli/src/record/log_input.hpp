/// A log, line by line, in bounded memory: a file, or standard input.
#ifndef ROIO_CLI_LOG_INPUT_HPP
#define ROIO_CLI_LOG_INPUT_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "form/input_line.hpp"

namespace roio::cli {

/// A signal came while a pipe waited for its writer.
struct Interrupted {};

class LogInput {
 public:
  /// @param name "-": standard input.
  /// @throws Failure: it cannot be opened, or is no log but a capture; Interrupted.
  explicit LogInput(const std::string& name);
  LogInput(const LogInput&) = delete;
  LogInput& operator=(const LogInput&) = delete;
  ~LogInput();

  /// For messages.
  [[nodiscard]] const std::string& name() const { return name_; }

  /// The next line that is there already; valid until the next call of anything here.
  std::optional<std::string_view> next() { return reader_.next(); }
  /// Waits for more.
  /// @return false at the end, or when a signal came.
  /// @throws Failure: it cannot be read.
  bool fill();

  /// Whether begin_again() can be: it is a file, not a pipe.
  [[nodiscard]] bool is_file() const { return size_.has_value(); }
  void begin_again();
  /// How much of a file has been read, 0..1.
  [[nodiscard]] std::optional<double> share() const;

 private:
  void refuse_capture() const;

  std::string name_;
  int fd_;
  std::optional<std::uint64_t> size_;
  bool at_end_ = false;
  LineReader reader_;
};

}  // namespace roio::cli

#endif
