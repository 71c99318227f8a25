#ifndef ROIO_SIM_NETWORK_CORE_HPP
#define ROIO_SIM_NETWORK_CORE_HPP

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <roio/sim/network.hpp>
#include <thread>
#include <vector>

#include "network/station.hpp"

namespace roio::sim {

/// How far simulated time should have come by now.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param speed simulated seconds in a real one, above 0.
  explicit Pace(double speed) : speed_(speed), start_(Clock::now()) {}

  [[nodiscard]] SimTime due() const;
  /// When `time` will be due.
  [[nodiscard]] Clock::time_point real(SimTime time) const;

 private:
  double speed_;
  Clock::time_point start_;
};

/// The wire, the stations on it, and the thread that runs them. A Network has it together with its
/// participants, so that these may be there longer; nothing runs any more then.
class NetworkCore {
 public:
  explicit NetworkCore(const NetworkOptions& options);
  NetworkCore(const NetworkCore&) = delete;
  NetworkCore& operator=(const NetworkCore&) = delete;
  ~NetworkCore() { stop(); }

  /// Does what it has been asked to, then ends the thread and tells the participants.
  void stop();

  /// Calls an action in the simulation's thread and waits for it. Throws what it throws.
  /// @return false: the simulation has ended, nothing was called.
  bool call(const std::function<void()>& action);

  /// How far simulated time should have come by now: the beginning of all, when it is not paced.
  [[nodiscard]] SimTime due() const { return pace_ ? pace_->due() : SimTime(0); }

  /// Frames wait in an exchange where none did.
  void wake();

  /// A new station, which goes when its exchange wants to leave. @return false: it could not take
  /// part.
  bool add(const std::shared_ptr<Exchange>& exchange);

  [[nodiscard]] const NetworkOptions& options() const { return options_; }
  /// For actions only.
  [[nodiscard]] CanBus& bus() { return bus_; }

 private:
  void run();
  bool run_calls();
  void advance();
  void wait();
  void poll_stations();
  void remove_leaving();
  void schedule_poll();
  [[nodiscard]] bool is_busy() const;

  const NetworkOptions options_;
  const BitTiming timing_;

  std::optional<Pace> pace_;  // none: as fast as it goes. Never changed.

  // The simulation's thread's, once it runs.
  const Timestamp epoch_;
  CanBus bus_;
  std::optional<HostNode> witness_;
  std::vector<std::unique_ptr<Station>> stations_;
  SimTime busy_seen_{0};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::packaged_task<void()>*> calls_;
  bool woken_ = false;
  bool stopping_ = false;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace roio::sim

#endif
