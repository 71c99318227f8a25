/// A simulated wire with a bridge for each participant: a board that runs the firmware's own image,
/// behind a pseudo terminal.
#ifndef ROIO_TESTS_CONTRACT_BRIDGED_BUS_HPP
#define ROIO_TESTS_CONTRACT_BRIDGED_BUS_HPP

#include <memory>
#include <roio/bus.hpp>
#include <roio/sim/network.hpp>
#include <string>
#include <vector>

namespace roio::test {

class BridgedBus {
 public:
  BridgedBus();
  ~BridgedBus();
  BridgedBus(const BridgedBus&) = delete;
  BridgedBus& operator=(const BridgedBus&) = delete;

  /// Of all participants: the device leads to the board that was plugged in last.
  [[nodiscard]] std::string url() const { return "serial:" + device_; }
  /// One more board, and the bus that it is.
  [[nodiscard]] std::unique_ptr<Bus> join(const OpenOptions& options);

 private:
  struct Bridge;

  std::string folder_;
  std::string device_;
  sim::Network network_;  // with a witness: a participant that is alone gets rid of its frames
  std::vector<std::unique_ptr<Bridge>> bridges_;
};

}  // namespace roio::test

#endif
