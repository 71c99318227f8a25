/// What `send BUS -` reads: one message a line, as JSON or as candump's log.
#ifndef ROIO_CLI_INPUT_LINE_HPP
#define ROIO_CLI_INPUT_LINE_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <roio/address.hpp>
#include <roio/bus.hpp>
#include <roio/frame.hpp>
#include <roio/robot.hpp>
#include <roio/text.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace roio::cli {

struct InputLine {
  enum class Kind : std::uint8_t {
    frame,
    news,     ///< Tells of the bus that it comes from: an error report, a loss, a state.
    comment,  ///< For people.
  };
  Kind kind;
  Frame frame{};                    ///< Of kind frame; one that can be sent.
  std::string interface_name{};     ///< That a log has it from; empty: it is from no log.
  std::optional<Timestamp> time{};  ///< That it says, where it can be read.
};

/// Reads one line that is not blank. "{" begins JSON as `dump --json` writes it (a message's source
/// is `default_source` when it names none), "(" a line of a log, whatever its time, and "#", ";" or
/// "//" a comment; else it is a frame as cansend takes it.
/// @param robot whose names a line of JSON may have; null: none.
/// @return an error says what was expected.
Parsed<InputLine> parse_input_line(std::string_view line, Address default_source,
                                   const Robot* robot = nullptr);

bool is_blank(std::string_view line) noexcept;

/// Cuts what comes from a file descriptor into lines, in bounded memory.
class LineReader {
 public:
  static constexpr std::size_t max_line = 65536;  ///< Bytes; of a longer line, the rest is skipped.

  /// @param name of what is read, for messages.
  explicit LineReader(int fd, std::string name = "standard input")
      : fd_(fd), name_(std::move(name)) {}

  /// The next line that has come whole, without its end; at the end of the input also one that has
  /// none. Valid until the next call.
  std::optional<std::string_view> next();

  /// Reads more; may wait.
  /// @return false at the end of the input.
  /// @throws Failure: the input cannot be read.
  bool fill();

 private:
  int fd_;
  std::string name_;
  std::string text_;
  std::size_t begin_ = 0;  // of what next() has not returned yet
  bool at_end_ = false;
  bool skipping_ = false;  // the rest of a line that was too long
};

}  // namespace roio::cli

#endif
