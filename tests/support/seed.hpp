#ifndef ROIO_TESTS_SEED_HPP
#define ROIO_TESTS_SEED_HPP

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>

namespace roio::test {

/// A generator for randomised tests: seeded from ROIO_SEED when that is set, and printed either
/// way, so that a failure can be run again.
inline std::mt19937 seeded_generator() {
  const char* const given = std::getenv("ROIO_SEED");
  const auto seed = given != nullptr ? static_cast<std::uint32_t>(std::strtoul(given, nullptr, 10))
                                     : static_cast<std::uint32_t>(std::random_device{}());
  std::cout << "ROIO_SEED=" << seed << '\n';
  return std::mt19937(seed);
}

/// Uniform in 0..max, both included.
inline std::uint32_t up_to(std::mt19937& generator, std::uint32_t max) {
  return std::uniform_int_distribution<std::uint32_t>(0, max)(generator);
}

}  // namespace roio::test

#endif
