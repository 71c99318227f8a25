#ifndef ROIO_LOCAL_BUS_HPP
#define ROIO_LOCAL_BUS_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <string>

namespace roio {

/// The part of open() that is the local bus.
/// @throws std::system_error with an Errc, its argument the bus's name.
std::unique_ptr<Bus> open_local(const std::string& bus_name,
                                std::optional<std::uint32_t> bitrate_bps,
                                const OpenOptions& options);

}  // namespace roio

#endif
