/// How long the tests go on, in simulated time.
#ifndef ROIO_TESTS_FIRMWARE_LOAD_SPANS_HPP
#define ROIO_TESTS_FIRMWARE_LOAD_SPANS_HPP

#include <chrono>
#include <cstdlib>

namespace roio::load {

/// What is usual, or what ROIO_SOAK_SECONDS says if it is set: scripts/soak asks for an hour.
inline std::chrono::milliseconds soak_span(std::chrono::seconds usual) {
  const char* const given = std::getenv("ROIO_SOAK_SECONDS");
  return given != nullptr ? std::chrono::seconds(std::strtoll(given, nullptr, 10)) : usual;
}

}  // namespace roio::load

#endif
