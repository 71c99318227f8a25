#ifndef ROIO_SOCKETCAN_BUS_HPP
#define ROIO_SOCKETCAN_BUS_HPP

#include <memory>
#include <roio/bus.hpp>
#include <string>

namespace roio {

/// The part of open() that is SocketCAN.
/// @throws std::system_error with an Errc, its argument the bus's name.
std::unique_ptr<Bus> open_socketcan(const std::string& interface_name, const OpenOptions& options);

}  // namespace roio

#endif
