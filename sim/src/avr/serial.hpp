/// AvrSerial: a serial line between a board and whoever is at its other end: a UART, or a USB
/// device that is one.
#ifndef ROIO_SIM_AVR_SERIAL_HPP
#define ROIO_SIM_AVR_SERIAL_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <roio/sim/board.hpp>
#include <span>

#include "avr/core.hpp"

namespace roio::sim {

class AvrSerial {
 public:
  /// Called when a byte has begun, with the cycle at which the other end has all of it.
  using Sender = std::function<void(AvrCore::Cycle, std::uint8_t)>;

  AvrSerial() = default;
  virtual ~AvrSerial() = default;
  AvrSerial(const AvrSerial&) = delete;
  AvrSerial& operator=(const AvrSerial&) = delete;

  void on_send(Sender sender) { sender_ = std::move(sender); }
  /// From the other end.
  virtual void receive(std::span<const std::uint8_t> bytes) = 0;
  /// Bytes of receive() that have not begun yet.
  [[nodiscard]] virtual std::size_t waiting() const = 0;
  /// None: a line without a rate.
  [[nodiscard]] virtual std::optional<double> bitrate_bps() const = 0;
  /// The other end takes nothing from the board, or does again.
  /// @return false: it has no way to say so, and takes what comes.
  virtual bool hold(bool holds) = 0;
  virtual void reset() = 0;
  /// An interrupt was entered: those that last as long as their flag does are asked for again.
  virtual void interrupt_entered(const avr_int_vector_t& vector) = 0;
  [[nodiscard]] const SerialCounters& counters() const { return counters_; }

 protected:
  void send(AvrCore::Cycle end, std::uint8_t byte) {
    if (sender_) {
      sender_(end, byte);
    }
  }
  [[nodiscard]] SerialCounters& counters() { return counters_; }

 private:
  SerialCounters counters_;
  Sender sender_;
};

}  // namespace roio::sim

#endif
