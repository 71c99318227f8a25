#ifndef ROIO_TESTS_UNIVERSE_HPP
#define ROIO_TESTS_UNIVERSE_HPP

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <roio/filter.hpp>
#include <vector>

#include "seed.hpp"

namespace roio::test {

/// Some of the 29 identifier bits, picked at random. Rules that look at no other bit are judged
/// completely by trying the identifiers that differ in these: what is proved of them is proved of
/// all 2^29.
class Universe {
 public:
  explicit Universe(std::mt19937& generator, std::uint32_t bits = 10) : bits_(29) {
    std::iota(bits_.begin(), bits_.end(), 0U);
    std::shuffle(bits_.begin(), bits_.end(), generator);
    bits_.resize(bits);
  }

  /// How many identifiers there are to try.
  [[nodiscard]] std::uint32_t size() const { return 1U << bits_.size(); }

  /// Spreads the low bits of index over the picked ones.
  [[nodiscard]] std::uint32_t id(std::uint32_t index) const {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      result |= ((index >> i) & 1U) << bits_[i];
    }
    return result;
  }

  [[nodiscard]] std::uint32_t random_id(std::mt19937& generator) const {
    return id(up_to(generator, size() - 1));
  }

  /// A rule over the picked bits; one with few masked bits is as likely as one with many.
  [[nodiscard]] FilterRule random_rule(std::mt19937& generator) const {
    const auto bits = static_cast<std::uint32_t>(bits_.size());
    const std::uint32_t density = up_to(generator, bits);
    std::uint32_t mask = 0;
    for (const std::uint32_t bit : bits_) {
      mask |= (up_to(generator, bits - 1) < density ? 1U : 0U) << bit;
    }
    return {random_id(generator) & mask, mask, FilterMeaning::custom};
  }

  /// Rules of which half share a mask: the shape that real ones have, and the one where merging and
  /// sharing out get interesting.
  [[nodiscard]] std::vector<FilterRule> random_rules(std::mt19937& generator,
                                                     std::size_t count) const {
    std::vector<FilterRule> rules;
    const std::uint32_t mask = random_rule(generator).mask;
    for (std::size_t i = 0; i < count; ++i) {
      const bool related = up_to(generator, 1) == 0;
      rules.push_back(related ? FilterRule{random_id(generator) & mask, mask, FilterMeaning::custom}
                              : random_rule(generator));
    }
    return rules;
  }

 private:
  std::vector<std::uint32_t> bits_;
};

inline bool any_accepts(const std::vector<FilterRule>& rules, std::uint32_t id) {
  return std::any_of(rules.begin(), rules.end(), [id](const FilterRule& rule) {
    return (id & rule.mask) == (rule.match & rule.mask);
  });
}

}  // namespace roio::test

#endif
