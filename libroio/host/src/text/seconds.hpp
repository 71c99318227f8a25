#ifndef ROIO_SECONDS_HPP
#define ROIO_SECONDS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string_view>

namespace roio {

inline constexpr const char* latest_time = "9223372036.854775807";

/// A time from decimal digits before and after its point; digits past the ninth are cut off.
/// @param seconds, fraction digits only, as is_digits() says; fraction may be empty.
/// @return nothing when it is later than latest_time.
std::optional<Timestamp> read_seconds(std::string_view seconds, std::string_view fraction) noexcept;

/// A time as a whole number of microseconds since 1970; what is before that becomes 0.
std::uint64_t microseconds(Timestamp time) noexcept;

/// Writes exactly `digits` decimal digits, with leading zeros.
/// @return one past the last character written.
char* write_decimal(char* out, std::uint64_t value, std::size_t digits) noexcept;

}  // namespace roio

#endif
