#include "text/seconds.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace roio {
namespace {

constexpr std::uint64_t ns_per_s = 1000000000;
constexpr std::size_t ns_digits = 9;
constexpr auto latest_ns = static_cast<std::uint64_t>(Timestamp::duration::max().count());

// "25" is 250,000,000 ns.
std::uint64_t fraction_ns(std::string_view digits) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < ns_digits; ++i) {
    value = 10 * value + (i < digits.size() ? static_cast<std::uint64_t>(digits[i] - '0') : 0U);
  }
  return value;
}

}  // namespace

std::optional<Timestamp> read_seconds(std::string_view seconds,
                                      std::string_view fraction) noexcept {
  std::uint64_t whole = 0;
  const auto [end, error] = std::from_chars(seconds.data(), seconds.data() + seconds.size(), whole);
  const std::uint64_t part = fraction_ns(fraction);
  if (error != std::errc() || whole > (latest_ns - part) / ns_per_s) {
    return std::nullopt;
  }
  return Timestamp(Timestamp::duration(static_cast<std::int64_t>(whole * ns_per_s + part)));
}

std::uint64_t microseconds(Timestamp time) noexcept {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(time.time_since_epoch().count(), 0)) /
         1000;
}

char* write_decimal(char* out, std::uint64_t value, std::size_t digits) noexcept {
  for (std::size_t i = digits; i > 0; --i) {
    out[i - 1] = static_cast<char>('0' + value % 10);
    value /= 10;
  }
  return out + digits;
}

}  // namespace roio
