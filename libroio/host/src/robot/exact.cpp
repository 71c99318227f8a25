#include "robot/exact.hpp"

#include <algorithm>
#include <numeric>

#include "text/decimal.hpp"

namespace roio::robot_file {
namespace {

constexpr unsigned max_decimals = 19;
constexpr int max_digits = 30;

Wide power_of_ten(int exponent) {
  Wide power = 1;
  for (; exponent > 0; --exponent) {
    power *= 10;
  }
  return power;
}

/// Takes the digits at the start of a text away.
std::string_view take_digits(std::string_view& text) {
  std::size_t count = 0;
  while (count < text.size() && is_digit(text[count])) {
    ++count;
  }
  const std::string_view digits = text.substr(0, count);
  text.remove_prefix(count);
  return digits;
}

bool take(std::string_view& text, char character) {
  const bool is_there = text.starts_with(character);
  text.remove_prefix(is_there ? 1 : 0);
  return is_there;
}

/// The exponent behind an e, past 100,000 as that; nothing: not well-formed.
std::optional<int> take_exponent(std::string_view& text) {
  constexpr int largest = 100000;
  const bool is_negative = take(text, '-');
  if (!is_negative) {
    take(text, '+');
  }
  const std::string_view digits = take_digits(text);
  if (digits.empty()) {
    return std::nullopt;
  }
  int value = 0;
  for (const char digit : digits) {
    value = std::min(largest, value * 10 + (digit - '0'));
  }
  return is_negative ? -value : value;
}

/// Digits one by one, and where the point is.
class Collector {
 public:
  void add(std::string_view digits, bool behind_point) {
    for (const char digit : digits) {
      if (units_ < limit_) {
        units_ = units_ * 10 + (digit - '0');
        exponent_ -= behind_point ? 1 : 0;
      } else {
        has_more_ = has_more_ || digit != '0';
        exponent_ += behind_point ? 0 : 1;
      }
    }
  }

  [[nodiscard]] Decimal decimal(bool is_negative, int exponent) {
    exponent_ += exponent;
    to_decimals();
    drop_zeros();
    return {is_negative && (units_ != 0 || has_more_), units_, static_cast<unsigned>(-exponent_),
            has_more_};
  }

 private:
  void to_decimals() {
    for (; exponent_ < -static_cast<int>(max_decimals) && units_ != 0; ++exponent_) {
      has_more_ = has_more_ || units_ % 10 != 0;
      units_ /= 10;
    }
    for (; exponent_ > 0 && units_ != 0 && units_ < limit_; --exponent_) {
      units_ *= 10;
    }
    units_ = exponent_ > 0 ? std::min(units_, limit_) : units_;
    exponent_ = std::clamp(exponent_, -static_cast<int>(max_decimals), 0);
  }

  void drop_zeros() {
    while (exponent_ < 0 && units_ % 10 == 0) {
      units_ /= 10;
      ++exponent_;
    }
  }

  const Wide limit_ = power_of_ten(max_digits);
  Wide units_ = 0;
  int exponent_ = 0;
  bool has_more_ = false;
};

/// What no field can hold is as good as this.
constexpr std::int64_t past_all = std::int64_t{1} << 60U;

std::int64_t bounded(Wide value) {
  return static_cast<std::int64_t>(std::min<Wide>(value, past_all));
}

/// Whether a fraction with this denominator has an end as a decimal.
bool ends(std::uint64_t denominator) {
  for (const unsigned factor : {2U, 5U}) {
    while (denominator % factor == 0) {
      denominator /= factor;
    }
  }
  return denominator == 1;
}

/// The least decimals that tell one step from the next: 10^-decimals is a step or less.
unsigned decimals_of(Fraction scale) {
  unsigned decimals = 0;
  for (std::uint64_t unit = scale.numerator; unit < scale.denominator; unit *= 10) {
    ++decimals;
  }
  return decimals;
}

/// "125" with 1 decimal is 12.5; zeros behind the point are left out.
std::string with_point(Wide units, unsigned decimals) {
  std::string digits;
  for (; units != 0 || digits.size() <= decimals; units /= 10) {
    digits += static_cast<char>('0' + static_cast<int>(units % 10));
  }
  std::reverse(digits.begin(), digits.end());
  if (decimals == 0) {
    return digits;
  }
  digits.insert(digits.size() - decimals, 1, '.');
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') {
    digits.pop_back();
  }
  return digits;
}

}  // namespace

std::optional<Decimal> read_decimal_number(std::string_view text) {
  const bool is_negative = take(text, '-');
  const std::string_view whole = take_digits(text);
  if (whole.empty() || (whole.size() > 1 && whole[0] == '0')) {
    return std::nullopt;
  }
  Collector collector;
  collector.add(whole, false);
  if (take(text, '.')) {
    const std::string_view fraction = take_digits(text);
    if (fraction.empty()) {
      return std::nullopt;
    }
    collector.add(fraction, true);
  }
  int exponent = 0;
  if (take(text, 'e') || take(text, 'E')) {
    const auto taken = take_exponent(text);
    if (!taken) {
      return std::nullopt;
    }
    exponent = *taken;
  }
  return text.empty() ? std::optional(collector.decimal(is_negative, exponent)) : std::nullopt;
}

Steps steps_next_to(const Decimal& number, Fraction scale) {
  const Wide dividend = number.units * scale.denominator;
  const Wide divisor = power_of_ten(static_cast<int>(number.decimals)) * scale.numerator;
  const std::int64_t nearer = bounded(dividend / divisor);
  const bool is_exact = dividend % divisor == 0 && !number.has_more;
  const std::int64_t farther = nearer + (is_exact ? 0 : 1);
  return number.is_negative ? Steps{-farther, -nearer} : Steps{nearer, farther};
}

std::string step_text(std::int64_t raw, Fraction scale) {
  const Wide magnitude = raw < 0 ? -static_cast<Wide>(raw) : static_cast<Wide>(raw);
  const std::uint64_t common = std::gcd(scale.numerator, scale.denominator);
  const std::uint64_t denominator = scale.denominator / common;
  const bool is_exact = ends(denominator);
  unsigned decimals = decimals_of(scale);
  Wide power = power_of_ten(static_cast<int>(decimals));
  for (; is_exact && power % denominator != 0; power *= 10) {
    ++decimals;
  }
  // Rounded, halves up: of an exact one nothing is left to round.
  const Wide units = (magnitude * (scale.numerator / common) * power * 2 + denominator) /
                     (static_cast<Wide>(denominator) * 2);
  return (raw < 0 && units != 0 ? "-" : "") + with_point(units, decimals);
}

double step_value(std::int64_t raw, Fraction scale) noexcept {
  return static_cast<double>(raw) * scale.numerator / scale.denominator;
}

}  // namespace roio::robot_file
