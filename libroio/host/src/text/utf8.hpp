#ifndef ROIO_UTF8_HPP
#define ROIO_UTF8_HPP

#include <cstddef>
#include <string_view>

namespace roio {

/// Bytes of the UTF-8 sequence that a text starts with, 1..4; 0 when there is none: an empty text,
/// a stray or missing continuation byte, an overlong form, a surrogate, above U+10FFFF. Source: RFC
/// 3629 section 4.
std::size_t utf8_sequence_length(std::string_view text) noexcept;

/// Where the first byte is that belongs to no UTF-8 sequence; text.size() when all do.
std::size_t find_not_utf8(std::string_view text) noexcept;

}  // namespace roio

#endif
