#ifndef ROIO_ROBOT_EXACT_HPP
#define ROIO_ROBOT_EXACT_HPP

#include <cstdint>
#include <optional>
#include <roio/kind.hpp>
#include <string>
#include <string_view>

namespace roio::robot_file {

__extension__ using Wide = __int128;

/// A decimal number as it is written: units / 10^decimals, trailing zeros away. Exact for all that
/// a field can hold: a step of 1 / 524288 has 19 decimals, the largest value of such steps 30
/// digits.
struct Decimal {
  bool is_negative = false;
  Wide units = 0;         ///< Below 10^31; a number above 10^30 counts as 10^30.
  unsigned decimals = 0;  ///< 0..19.
  bool has_more = false;  ///< Digits behind the 19th decimal, which no step has.

  friend bool operator==(const Decimal& a, const Decimal& b) {
    return a.is_negative == b.is_negative && a.units == b.units && a.decimals == b.decimals &&
           a.has_more == b.has_more;
  }
};

/// A number as JSON writes it: -12.5, 1e3. @return nothing for another text.
std::optional<Decimal> read_decimal_number(std::string_view text);

/// The steps of a scale next to a number, on the wire; both are the same where it is a step.
struct Steps {
  std::int64_t lower = 0;
  std::int64_t upper = 0;

  [[nodiscard]] bool is_exact() const { return lower == upper; }
};
/// @param scale both parts 1..1,000,000.
Steps steps_next_to(const Decimal& number, Fraction scale);

/// A step in the unit: "-12.5"; with as many digits as Reading::text() has.
std::string step_text(std::int64_t raw, Fraction scale);
double step_value(std::int64_t raw, Fraction scale) noexcept;

}  // namespace roio::robot_file

#endif
