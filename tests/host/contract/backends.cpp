#include "backends.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <roio/sim/network.hpp>
#include <utility>

#include "memory_bus.hpp"

#ifdef ROIO_IMAGES_DIR
#include "bridged_bus.hpp"
#endif

namespace roio::test {
namespace {

std::string fresh_name() {
  static std::atomic<int> count{0};
  return "contract-" + std::to_string(::getpid()) + "-" + std::to_string(++count);
}

/// A bus that is found by its URL.
Venue by_url(const std::string& url) {
  return {url, [url](const OpenOptions& options) { return open(url, options); }};
}

Venue fresh_local(const std::string& options = "") {
  return by_url("local:" + fresh_name() + options);
}

/// A simulated wire with a simulated MCP2515 for each participant, and the driver on it. A further
/// node acknowledges and sends nothing, so that a participant that is alone gets rid of its frames,
/// as it does on a local bus.
Venue fresh_chips() {
  const std::string name = "sim:" + fresh_name();
  const auto network = std::make_shared<sim::Network>(
      sim::NetworkOptions{.name = name, .bitrate_bps = 500'000, .witness = true});
  return {name, [network](const OpenOptions& options) { return network->join(options); }};
}

/// The example of docs/backend.md.
Venue fresh_memory() {
  const std::string name = "memory:" + fresh_name();
  return {name, [wire = make_memory_wire(name)](const OpenOptions& options) {
            return open_memory_bus(wire, options);
          }};
}

#ifdef ROIO_IMAGES_DIR
Venue fresh_bridges() {
  const auto bus = std::make_shared<BridgedBus>();
  return {bus->url(), [bus](const OpenOptions& options) { return bus->join(options); }};
}
#endif

}  // namespace

std::vector<Backend> backends() {
  std::vector<Backend> all;
  all.push_back({.name = "local",
                 .fresh = [] { return fresh_local(); },
                 .arbitrates = false,
                 .paced = false,
                 .one_order = true,
                 .refills_fast = true,
                 .there_at_once = true,
                 .flood = 80'000});
  all.push_back({.name = "local_500k",
                 .fresh = [] { return fresh_local("?bitrate=500000"); },
                 .arbitrates = true,
                 .paced = true,
                 .one_order = true,
                 .refills_fast = true,
                 .there_at_once = true,
                 .flood = 3'000});
  all.push_back({.name = "simulated_chips",
                 .fresh = fresh_chips,
                 .arbitrates = true,
                 .paced = true,
                 .one_order = true,
                 .refills_fast = true,
                 .there_at_once = true,
                 .flood = 5'000});
  all.push_back({.name = "memory",
                 .fresh = fresh_memory,
                 .arbitrates = false,
                 .paced = false,
                 .one_order = true,
                 .refills_fast = true,
                 .there_at_once = true,
                 .flood = 50'000});
#ifdef ROIO_IMAGES_DIR
  all.push_back({.name = "serial",
                 .fresh = fresh_bridges,
                 .arbitrates = true,
                 .paced = true,
                 .one_order = true,
                 .refills_fast = false,
                 .there_at_once = false,
                 .flood = 5'000});
#endif
  if (const char* const interface_name = std::getenv("ROIO_TEST_CAN")) {
    all.push_back({.name = "socketcan",
                   .fresh = [name = std::string(interface_name)] { return by_url(name); },
                   .arbitrates = false,
                   .paced = false,
                   .one_order = false,
                   .refills_fast = true,
                   .there_at_once = true,
                   .flood = 250'000});
  }
  return all;
}

}  // namespace roio::test
