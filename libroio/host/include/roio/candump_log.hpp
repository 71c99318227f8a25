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
#include <roio/frame.hpp>
#include <roio/text.hpp>

namespace roio {

struct LogLine {
  Timestamp time{};
  std::string interface_name;  ///< 1..15 bytes, none of them white space.
  Frame frame{};
};

/// One line, without or with its line end. Anything after the frame but white space is refused,
/// except canplayer's own " R" or " T" direction mark. CAN FD ("##") and CAN XL frames are refused
/// by name.
Parsed<LogLine> parse_log_line(std::string_view line);

/// The frame part alone: "123#1122", as cansend takes it (dots between bytes allowed).
Parsed<Frame> parse_frame_text(std::string_view text);

/// Room for the longest line that format_log_line() writes.
inline constexpr std::size_t max_log_line = 96;

/// Writes one line with its '\n', byte for byte what candump -L prints.
/// @param interface_name cut off after 63 bytes.
/// @return bytes written, no terminating zero.
std::size_t format_log_line(std::span<char, max_log_line> out, Timestamp time,
                            std::string_view interface_name, const Frame& frame) noexcept;

/// The frame part alone, no line end.
std::string to_text(const Frame& frame);

}  // namespace roio

#endif
