/// Forwarder: hands on every frame of one bus to another, and counts what it could not.
#ifndef ROIO_CLI_FORWARD_HPP
#define ROIO_CLI_FORWARD_HPP

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <roio/bus.hpp>
#include <span>
#include <string>
#include <thread>

namespace roio::cli {

/// A bus under the name that users know it by.
struct NamedBus {
  Bus& bus;
  std::string name;
};

/// One way, in a thread of its own, from its construction to stop(). Both buses must outlive it;
/// nobody else may receive from one, or send to the other.
class Forwarder {
 public:
  /// Sees the frames before they are handed on, in the Forwarder's thread. What it throws ends
  /// that.
  using Inspect = std::function<void(std::span<const Frame>)>;

  Forwarder(NamedBus from, NamedBus to, Inspect inspect = {});
  Forwarder(const Forwarder&) = delete;
  Forwarder& operator=(const Forwarder&) = delete;
  ~Forwarder() { stop(); }

  /// Hands on what has come until now, for some moments at most. What waits on the buses must have
  /// been cancelled.
  void stop();
  /// Whether it has ended for an error. After stop(), rethrow() tells.
  [[nodiscard]] bool failed() const noexcept { return failed_; }
  void rethrow() const;

  /// "vcan0 to /dev/ttyACM0: 12 frames, 3 lost (1 on the way from vcan0, ...)".
  [[nodiscard]] std::string report() const;

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool going() const { return !stopping_ || Clock::now() < stop_at_; }
  void run();
  void forward(std::span<const Frame> frames);

  NamedBus from_;
  NamedBus to_;
  Inspect inspect_;
  Timeout patience_;
  Clock::time_point stop_at_;  // once stopping_ is set
  std::atomic<bool> stopping_{false};
  std::atomic<bool> failed_{false};
  std::atomic<std::uint64_t> not_taken_{0};
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace roio::cli

#endif
