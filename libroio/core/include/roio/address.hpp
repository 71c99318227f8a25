/// Address: who a node is. Written SUBNET.NODE, "0.2"; "0.*" is everybody in subnet 0.
/// Source: docs/protocol.md "Addresses".
#ifndef ROIO_ADDRESS_HPP
#define ROIO_ADDRESS_HPP

#include <stdint.h>

namespace roio {

constexpr uint8_t max_subnet = 31;       ///< Subnets are 0..31.
constexpr uint8_t max_node = 254;        ///< A node's own number is 0..254.
constexpr uint8_t broadcast_node = 255;  ///< As a destination: every node of the subnet.

struct Address {
  uint8_t subnet;  ///< 0..31.
  uint8_t node;    ///< 0..254; 255 only as a destination.
};

constexpr bool operator==(Address a, Address b) {
  return a.subnet == b.subnet && a.node == b.node;
}
constexpr bool operator!=(Address a, Address b) {
  return !(a == b);
}

/// Every node of a subnet at once; valid as a destination only.
constexpr Address broadcast_of(uint8_t subnet) {
  return Address{subnet, broadcast_node};
}

constexpr bool is_broadcast(Address address) {
  return address.node == broadcast_node;
}

/// Whether a message may be sent to this address.
constexpr bool is_valid_destination(Address address) {
  return address.subnet <= max_subnet;
}

/// Whether a node may have this address, and so whether it may stand as a source.
constexpr bool is_valid_source(Address address) {
  return address.subnet <= max_subnet && address.node <= max_node;
}

}  // namespace roio

#endif
