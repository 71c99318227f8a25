#ifndef ROIO_SERIAL_PORTS_HPP
#define ROIO_SERIAL_PORTS_HPP

#include <string>
#include <vector>

namespace roio::serial {

/// Where a bridge may be, see find_bridges(); sorted.
/// @throws Errc::relative_path: ROIO_SERIAL_PORTS has one.
std::vector<std::string> likely_ports();

/// What the USB device behind a port calls itself; empty: it has no name, or is none.
std::string product_of(const std::string& path);

/// Whether any process that this user may look into has the port open. Never for what is no serial
/// port, nor for a pseudo terminal: whoever made one may keep it open.
bool is_open_anywhere(const std::string& path);

/// How a user who may not open a port comes to it: "join its group dialout: `sudo usermod -aG
/// dialout $USER`, and log in again", or that no group may.
std::string how_to_be_permitted(const std::string& path);

}  // namespace roio::serial

#endif
