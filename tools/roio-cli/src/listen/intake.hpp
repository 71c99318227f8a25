/// What comes in from one bus or from several: in the order of each bus, and of the times of all as
/// far as buses bring their frames within milliseconds. A bridge may be slower, and clocks may be
/// set: no bus waits long for another's times.
#ifndef ROIO_CLI_INTAKE_HPP
#define ROIO_CLI_INTAKE_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <span>
#include <vector>

#include "program/interrupt.hpp"

namespace roio::cli {

struct Heard {
  std::size_t from;  ///< Which bus.
  const Received* received;
};

class Intake {
 public:
  explicit Intake(std::span<const std::unique_ptr<Bus>> buses);

  /// Waits until there is something. What more than `most` has come stays on its bus, as does what
  /// another bus may still have something before.
  /// @return ok: heard() has something; timeout; or cancelled, by a signal.
  Result receive(std::size_t most, Timeout timeout);

  /// Takes what has come by now, in order, without waiting, and holds nothing back. At the end.
  void take(std::size_t most);

  /// What receive() or take() has found, in order; valid until either is called again.
  [[nodiscard]] std::span<const Heard> heard() const { return heard_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// What has come in from a bus and has not been given yet.
  struct Waiting {
    std::vector<Received> batch;
    std::size_t next = 0;
    std::size_t end = 0;
    bool may_have_more = false;   ///< On the bus, as the batch was full.
    Clock::time_point arrived{};  ///< When the batch was taken from the bus.

    [[nodiscard]] bool is_empty() const { return next == end; }
  };

  Result receive_from_one(std::size_t most, Timeout timeout);
  Result receive_from_several(std::size_t most, Timeout timeout);
  [[nodiscard]] bool is_behind() const;
  void refill();
  void merge(std::size_t most, bool hold_back);
  [[nodiscard]] std::optional<std::size_t> earliest(Clock::time_point now) const;
  [[nodiscard]] static bool goes_before(const Waiting& one, const Waiting& other,
                                        Clock::time_point now);

  std::span<const std::unique_ptr<Bus>> buses_;
  std::vector<Waiting> waiting_;
  std::vector<int> fds_;
  std::vector<Heard> heard_;
  std::optional<CancelOnSignal> cancel_on_signal_;  ///< Of the one bus that is waited in.
};

}  // namespace roio::cli

#endif
