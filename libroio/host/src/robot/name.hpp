#ifndef ROIO_ROBOT_NAME_HPP
#define ROIO_ROBOT_NAME_HPP

#include <cstdint>
#include <string_view>

namespace roio::robot_file {

enum class FirstCharacter : std::uint8_t { letter, letter_or_digit, any };

inline constexpr const char* name_rule =
    "a name of 1 to 32 letters, digits, - and _, a letter first";
inline constexpr const char* choice_rule =
    "a name of 1 to 32 letters, digits, - and _, a letter or a digit first";

/// Whether a text has 1 to 32 letters, digits, '-' and '_', of ASCII.
bool is_name(std::string_view text, FirstCharacter first = FirstCharacter::letter) noexcept;

/// Whether a text is of one line, without control characters, and of `min` to `max` characters.
/// @param text UTF-8.
bool is_line(std::string_view text, std::size_t min, std::size_t max) noexcept;

}  // namespace roio::robot_file

#endif
