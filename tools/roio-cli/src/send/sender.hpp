/// Sends frames in order and knows what became of them: what `send` and `play` have in common.
#ifndef ROIO_CLI_SENDER_HPP
#define ROIO_CLI_SENDER_HPP

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <roio/frame.hpp>
#include <span>
#include <string>

namespace roio::cli {

struct SenderOptions {
  std::string bus;
  std::chrono::milliseconds timeout{1000};  ///< Of each frame.
  /// How long to wait, first, until somebody listens on the local bus.
  std::optional<std::chrono::milliseconds> wait{};
  bool in_order = true;  ///< As OpenOptions::in_order.
  bool alone = false;    ///< One message, and gone: who does that carries no bus for others.
};

/// @return null: with `alone`, nobody is there, and none is waited for.
/// @throws Failure: nobody came to listen; std::system_error.
std::unique_ptr<Bus> open_for_sending(const SenderOptions& options);

/// Waits as SenderOptions::wait says, from `start` on.
/// @return false when a signal came first.
/// @throws Failure: nobody came.
bool wait_for_listener(const SenderOptions& options, const Bus& bus,
                       std::chrono::steady_clock::time_point start);

class Sender {
 public:
  /// @param bus outlives this.
  Sender(Bus& bus, std::chrono::milliseconds timeout) : bus_(bus), timeout_(timeout) {}

  [[nodiscard]] std::uint64_t sent() const { return sent_; }

  /// @return false when a signal came first.
  /// @throws Failure: a frame had to wait longer than the timeout.
  bool send(std::span<const Frame> frames);

  /// Hands over what send() has accepted, closes the bus, and tells of what nobody was there for.
  /// @throws Failure: some of it was not handed over.
  void close();

 private:
  Bus& bus_;
  std::chrono::milliseconds timeout_;
  std::uint64_t sent_ = 0;
};

}  // namespace roio::cli

#endif
