#include <roio/sim/network.hpp>

#include "network/bus.hpp"
#include "network/core.hpp"

namespace roio::sim {

Network::Network(const NetworkOptions& options) : core_(std::make_shared<NetworkCore>(options)) {}

Network::~Network() {
  core_->stop();
}

std::unique_ptr<Bus> Network::join(const OpenOptions& options) {
  return open_network_bus(core_, options);
}

void Network::in_simulation(const std::function<void(CanBus&)>& action) {
  core_->call([this, &action] { action(core_->bus()); });
}

}  // namespace roio::sim
