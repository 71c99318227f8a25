#ifndef ROIO_TESTS_SOAK_HPP
#define ROIO_TESTS_SOAK_HPP

#include <cstdlib>

namespace roio::test {

/// Whether a test that takes a sample of many cases is to take all: scripts/soak sets ROIO_SOAK.
inline bool is_soak() {
  return std::getenv("ROIO_SOAK") != nullptr;
}

}  // namespace roio::test

#endif
