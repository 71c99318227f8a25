/// One frame as a line for people, in columns:
///
///   0.10   -> 0.2     normal  message  [3]  5A 2D 00
///   31.254 -> 31.*    urgent  system   [0]
///   foreign  11-bit 123                [2]  11 22
///   foreign  29-bit 1004A00A           [4]  remote request
///   error    00000040                  [8]  00 00 00 00 00 00 00 00  bus-off
///
/// and with a robot's names, in columns as wide as those:
///
///   pc     -> arm     normal  angles   shoulder=90 deg  elbow=45 deg  hand=0 deg
#ifndef ROIO_CLI_FRAME_TEXT_HPP
#define ROIO_CLI_FRAME_TEXT_HPP

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string>

#include "form/labels.hpp"

namespace roio::cli {

using Buffer = fmt::memory_buffer;

/// How far apart the columns stand.
enum class Gap : std::uint8_t {
  wide,    ///< Two spaces.
  narrow,  ///< One: beside an absolute time, the longest message still has 80 columns.
};

/// The terminal's colours.
enum class Colour : std::uint8_t {
  none,
  kinds,    ///< Urgent messages stand out, foreign frames stand back.
  sources,  ///< That, and each source has a colour, as far as there are some.
};

/// Appends the line without its end. Never allocates for a buffer that has room.
/// @param names what addresses and messages are called; null: by their numbers.
void append_frame(Buffer& out, const Frame& frame, Colour colour, Gap gap = Gap::wide,
                  const Labels* names = nullptr);

/// Whether a frame is a Roio message; the others are foreign, or error reports.
bool is_roio(const Frame& frame) noexcept;

/// The time column of `-t`, as candump's: a "(1436509052.249713) ", A, in the time zone of this
/// computer, "(2015-07-10 06:17:32.249713) ", d and z "(000.001234) ".
class TimeColumn {
 public:
  enum class Mode : char { none = 0, absolute = 'a', date = 'A', delta = 'd', zero = 'z' };

  explicit TimeColumn(Mode mode) : mode_(mode) {}

  /// Of the columns that follow.
  [[nodiscard]] Gap gap() const {
    return mode_ == Mode::absolute || mode_ == Mode::date ? Gap::narrow : Gap::wide;
  }

  /// Appends the column for the next frame; the first one of d and z is at 0, and a clock that
  /// went backwards shows as no time passed.
  void append(Buffer& out, Timestamp time);

 private:
  void append_date(Buffer& out, Timestamp time);
  void append_passed(Buffer& out, Timestamp time);

  Mode mode_;
  std::optional<Timestamp> reference_;
  std::optional<std::chrono::sys_seconds> dated_;  // the second that date_ says
  std::string date_;
};

}  // namespace roio::cli

#endif
