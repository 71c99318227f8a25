/// Network: a simulated CAN bus for host programs. Each program that joins has a roio::Bus, and
/// behind it a simulated MCP2515 that the real driver serves.
///
///   sim::Network network({.bitrate_bps = 500'000});
///   const auto robot = network.join();
///   const auto laptop = network.join();
///   robot->send(frame);
///
/// A thread of the network's own runs simulated time, for the bus and for the processors of all
/// participants: each driver is called every 25 us of simulated time. What these processors do
/// takes no simulated time, SPI included: at these intervals no chip is ever full. What the driver
/// makes of a slow SPI is tests/firmware/driver's subject, not this one's.
///
/// What differs from other kinds of Bus: arbitration, bit stuffing, errors and bus-off are the
/// wire's; two participants that send the same identifier at the same time collide, as they would
/// on any CAN bus. Received::time is the computer's clock at the beginning plus simulated time, to
/// 25 us. A computer too slow for the speed asked for falls behind: then simulated time is late,
/// and makes up for it when it can; nothing is skipped. A receiver's queue holds 4096 frames, and a
/// sender's 128 of each priority.
#ifndef ROIO_SIM_NETWORK_HPP
#define ROIO_SIM_NETWORK_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <roio/bus.hpp>
#include <roio/sim/can_bus.hpp>
#include <string>

namespace roio::sim {

class NetworkCore;

struct NetworkOptions {
  std::string name = "sim";  ///< Bus::name() of all who join.
  std::uint32_t bitrate_bps = 500'000;
  std::uint32_t osc_hz = 16'000'000;  ///< Of the chips.
  /// Simulated seconds in a real one. 0: as fast as it goes, and then it keeps one processor busy.
  double speed = 1;
  /// One more node, which sends nothing and acknowledges, so that a participant that is alone gets
  /// rid of its frames. Without it, such a one repeats its first frame for ever, and its controller
  /// becomes error-passive.
  bool witness = true;
};

class Network {
 public:
  /// @throws std::invalid_argument: no bit timing gives this rate with this oscillator, or the
  ///         speed is below 0; std::system_error: no thread to be had.
  explicit Network(const NetworkOptions& options = {});
  /// Participants that are still open find the bus absent from now on.
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// One more participant. Any thread.
  /// @throws std::system_error Errc::not_connected: the chip could not take part within
  ///         options.open_timeout, for instance because the wire is held at dominant.
  std::unique_ptr<Bus> join(const OpenOptions& options = {});

  /// Has the simulation's thread call `action` between two moments of simulated time, and waits for
  /// it: the one way to the wire, for faults, further nodes and what the bus adds up. Any thread
  /// but the simulation's own. Throws what the action throws.
  void in_simulation(const std::function<void(CanBus&)>& action);

 private:
  std::shared_ptr<NetworkCore> core_;
};

}  // namespace roio::sim

#endif
