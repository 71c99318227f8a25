#ifndef ROIO_FRAME_TEXT_HPP
#define ROIO_FRAME_TEXT_HPP

#include <cstddef>
#include <roio/frame.hpp>
#include <roio/text.hpp>
#include <string_view>

namespace roio {

/// The longest frame: 8 digits, '#', 8 bytes.
inline constexpr std::size_t max_frame_text = 8 + 1 + 2 * std::size_t{max_data_length};

/// parse_frame_text() with errors that do not quote the whole text, for texts of which it is a
/// part.
Parsed<Frame> read_frame(std::string_view text);

/// Writes a frame as candump -L does.
/// @param out room for max_frame_text characters.
/// @return one past the last character written.
char* write_frame(char* out, const Frame& frame) noexcept;

}  // namespace roio

#endif
