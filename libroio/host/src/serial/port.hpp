#ifndef ROIO_SERIAL_PORT_HPP
#define ROIO_SERIAL_PORT_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "parts/fork.hpp"

namespace roio::serial {

/// A serial port of this program's own: raw bytes, without flow control, nothing waits.
class SerialPort {
 public:
  /// @throws std::system_error Errc::no_such_port, not_a_port, port_in_use, port_not_permitted, or
  ///         the system's own; about `name`.
  SerialPort(const std::string& path, const std::string& name, std::uint32_t rate_bps);
  SerialPort(SerialPort&&) noexcept = default;
  SerialPort& operator=(SerialPort&&) noexcept = default;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  ~SerialPort() = default;  // the lock goes with the descriptor

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  [[nodiscard]] std::uint32_t rate_bps() const noexcept { return rate_bps_; }

  // Each: none means that the port is gone.

  /// What the port has not sent yet is thrown away.
  [[nodiscard]] bool set_rate(std::uint32_t rate_bps);
  /// @return how many bytes have come, maybe 0.
  std::optional<std::size_t> read(std::span<std::uint8_t> bytes) const;
  /// @return how many it took, maybe 0.
  std::optional<std::size_t> write(std::span<const std::uint8_t> bytes) const;

 private:
  ParentsFd fd_;
  std::uint32_t rate_bps_;
};

}  // namespace roio::serial

#endif
