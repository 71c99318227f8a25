/// Bus list: the buses that this machine has, as open() takes their names. Bridges on serial ports
/// are looked for by find_bridges(), in bridge.hpp.
#ifndef ROIO_BUS_LIST_HPP
#define ROIO_BUS_LIST_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <roio/bus.hpp>
#include <roio/export.hpp>

namespace roio {

struct CanInterface {
  std::string name;                   ///< "can0".
  std::string kind;                   ///< The kernel's word: "can", "vcan", "slcan"; may be empty.
  BusState state = BusState::active;  ///< Down when the interface is.
  std::optional<std::uint32_t> bitrate_bps;  ///< None: not set, or one that has none (vcan).
};

/// The CAN interfaces of this network namespace, in the kernel's order; none where the kernel has
/// no CAN.
/// @throws std::system_error: the kernel could not be asked.
ROIO_EXPORT std::vector<CanInterface> can_interfaces();

/// The local buses of this user that some program is on: "local:robot", sorted by name.
/// @throws std::system_error: a folder that cannot be read.
ROIO_EXPORT std::vector<std::string> local_buses();

}  // namespace roio

#endif
