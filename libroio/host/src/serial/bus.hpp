#ifndef ROIO_SERIAL_BUS_HPP
#define ROIO_SERIAL_BUS_HPP

#include <memory>
#include <roio/bus.hpp>
#include <roio/text.hpp>

namespace roio {

/// The part of open() that is a bridge on a serial port.
/// @throws std::system_error with an Errc, its argument the bus's name.
std::unique_ptr<Bus> open_serial(const BusUrl& url, const OpenOptions& options);

}  // namespace roio

#endif
