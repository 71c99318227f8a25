/// A host node that keeps what it received and what it sent.
#ifndef ROIO_TESTS_STATION_HPP
#define ROIO_TESTS_STATION_HPP

#include <roio/sim/host_node.hpp>
#include <string>
#include <vector>

#include "wire_text.hpp"

namespace roio::test {

class Station {
 public:
  explicit Station(sim::CanBus& bus, std::uint32_t bitrate_bps = 500'000,
                   sim::Controller::Mode mode = sim::Controller::Mode::normal)
      : node(bus, bitrate_bps, mode) {
    node.on_receive([this](const Frame& frame) { received.push_back(text_of(frame)); });
    node.on_sent([this](const Frame& frame) { sent.push_back(text_of(frame)); });
  }

  sim::HostNode node;
  std::vector<std::string> received;
  std::vector<std::string> sent;

  [[nodiscard]] unsigned transmit_errors() { return node.controller().transmit_errors(); }
  [[nodiscard]] unsigned receive_errors() { return node.controller().receive_errors(); }
  [[nodiscard]] sim::Confinement confinement() { return node.controller().confinement(); }
};

}  // namespace roio::test

#endif
