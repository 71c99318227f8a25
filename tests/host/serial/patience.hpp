/// Waiting in tests that run in real time: for as long as it takes, but not for ever.
#ifndef ROIO_TESTS_SERIAL_PATIENCE_HPP
#define ROIO_TESTS_SERIAL_PATIENCE_HPP

#include <chrono>
#include <functional>
#include <thread>

namespace roio::test {

inline constexpr std::chrono::seconds guard{30};  // against hanging only

/// @return false: it was not so until the guard's time was up.
inline bool becomes(const std::function<bool()>& it_is_so) {
  for (const auto end = std::chrono::steady_clock::now() + guard;
       std::chrono::steady_clock::now() < end && !it_is_so();) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return it_is_so();
}

}  // namespace roio::test

#endif
