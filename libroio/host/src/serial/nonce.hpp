#ifndef ROIO_SERIAL_NONCE_HPP
#define ROIO_SERIAL_NONCE_HPP

#include <cstdint>
#include <random>

namespace roio::serial {

/// A number for a session: the system's, so that no two programs have the same.
inline std::uint32_t random_nonce() {
  std::random_device device;
  return static_cast<std::uint32_t>(device());
}

}  // namespace roio::serial

#endif
