#ifndef ROIO_ROBOT_LIMITS_HPP
#define ROIO_ROBOT_LIMITS_HPP

#include <cstddef>
#include <cstdint>

namespace roio::robot_file {

/// The format that is read: the field "roio" of both files.
inline constexpr std::uint64_t format_version = 1;

/// Of a file, in bytes. A robot of a thousand places is a third of it.
inline constexpr std::size_t max_text = std::size_t{1} << 20U;
/// Objects and arrays in each other. The format has 6.
inline constexpr std::size_t max_depth = 16;

inline constexpr std::size_t max_name = 32;
/// Of texts for people, in characters (code points).
inline constexpr std::size_t max_unit = 16;
inline constexpr std::size_t max_title = 100;
inline constexpr std::size_t max_description = 1000;
/// A bus's name: a device's path may be long.
inline constexpr std::size_t max_bus = 1000;

/// Fields of a kind that a robot sets.
inline constexpr std::size_t max_settings = 100;

/// Of a fraction's two parts.
inline constexpr std::uint64_t max_part = 1000000;

}  // namespace roio::robot_file

#endif
