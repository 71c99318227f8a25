/// How long the tests go on, in simulated time.
#ifndef ROIO_TESTS_FIRMWARE_LOAD_SPANS_HPP
#define ROIO_TESTS_FIRMWARE_LOAD_SPANS_HPP

#include <chrono>
#include <cstdlib>

namespace roio::load {

#if defined(__SANITIZE_ADDRESS__)
constexpr int slowdown = 10;
#else
constexpr int slowdown = 1;
#endif

/// Seconds, fewer under a sanitizer.
inline std::chrono::milliseconds usual_span(int seconds) {
  return std::chrono::milliseconds(1000 * seconds / slowdown);
}

/// The same, but what ROIO_SOAK_SECONDS says if it is set: scripts/soak asks for an hour.
inline std::chrono::milliseconds soak_span(int seconds) {
  const char* const given = std::getenv("ROIO_SOAK_SECONDS");
  return given != nullptr ? std::chrono::seconds(std::strtoll(given, nullptr, 10))
                          : usual_span(seconds);
}

}  // namespace roio::load

#endif
