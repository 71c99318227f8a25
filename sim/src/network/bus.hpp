#ifndef ROIO_SIM_NETWORK_BUS_HPP
#define ROIO_SIM_NETWORK_BUS_HPP

#include <memory>
#include <roio/bus.hpp>

#include "network/core.hpp"

namespace roio::sim {

/// A participant as its program sees it. @throws see Network::join().
std::unique_ptr<Bus> open_network_bus(std::shared_ptr<NetworkCore> core,
                                      const OpenOptions& options);

}  // namespace roio::sim

#endif
