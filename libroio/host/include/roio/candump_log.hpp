/// The log format of can-utils: what `candump -L` prints and canplayer, log2asc and cansend read.
///
///   (1436509052.249713) vcan0 123#1122            standard
///   (1436509052.249713) vcan0 1004A00A#5A2D00     extended: always 8 digits
///   (1436509052.249713) vcan0 123#R4              remote, with the length asked for when not 0
///   (1436509052.249713) vcan0 20000004#0001...    error report: bit 29 set
/// Pure functions; no allocation when formatting.
/// Source: can-utils lib.c (parse_canframe, sprint_canframe), candump.c.
#ifndef ROIO_CANDUMP_LOG_HPP
#define ROIO_CANDUMP_LOG_HPP

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/frame.hpp>
#include <roio/text.hpp>

namespace roio {

/// The longest name in a line: "local:" and a bus name of 64 bytes (an interface's has at most 15).
inline constexpr std::size_t max_log_name = 70;

struct LogLine {
  Timestamp time{};
  std::string interface_name;  ///< 1..max_log_name bytes, no white space or control character.
  Frame frame{};
};

/// One line, without or with its line end ("\n" or "\r\n"). Anything after the frame but blanks is
/// refused, except the direction mark " R" or " T" of candump -x. CAN FD ("##") and CAN XL
/// frames are refused by name. Fractions of a second of 1..9 digits are taken.
ROIO_EXPORT Parsed<LogLine> parse_log_line(std::string_view line);

/// The same for who does not need the time: whatever stands in the brackets is taken, such as
/// "(-0.250000)", "(7)" or "(2015-07-10 08:17:32.249713)". LogLine::time is 0 where
/// parse_log_line() would refuse it.
ROIO_EXPORT Parsed<LogLine> parse_log_line_of_any_time(std::string_view line);

/// The frame part alone: "123#1122", as cansend takes it (dots between bytes allowed). A length
/// code above 8, as newer can-utils write it after 8 bytes or R8 ("_9" to "_F"), is read as the 8
/// that it means. Where cansend guesses, this refuses: a ninth byte, an identifier above 7FF in
/// three digits, text after R.
ROIO_EXPORT Parsed<Frame> parse_frame_text(std::string_view text);

/// Room for the longest line that format_log_line() writes.
inline constexpr std::size_t max_log_line = 117;

/// Writes one line with its '\n', byte for byte what candump -L prints.
/// @param time microseconds are shown; before 1970 (which candump cannot show) it becomes 0.
/// @param interface_name cut off after max_log_name bytes.
/// @param frame one that is_valid(); others are cut down to fields that fit.
/// @return bytes written, no terminating zero.
ROIO_EXPORT std::size_t format_log_line(std::span<char, max_log_line> out, Timestamp time,
                                        std::string_view interface_name,
                                        const Frame& frame) noexcept;

/// The frame part alone, no line end.
ROIO_EXPORT std::string to_text(const Frame& frame);

}  // namespace roio

#endif
