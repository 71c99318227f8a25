#ifndef ROIO_BACKENDS_HPP
#define ROIO_BACKENDS_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <roio/text.hpp>
#include <string>

namespace roio {

/// What open() chooses from; each throws std::system_error with an Errc, its argument the bus's
/// name.
std::unique_ptr<Bus> open_socketcan(const std::string& interface_name, const OpenOptions& options);
std::unique_ptr<Bus> open_local(const std::string& bus_name,
                                std::optional<std::uint32_t> bitrate_bps,
                                const OpenOptions& options);
std::unique_ptr<Bus> open_serial(const BusUrl& url, const OpenOptions& options);

}  // namespace roio

#endif
