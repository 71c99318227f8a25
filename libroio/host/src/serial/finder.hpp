#ifndef ROIO_SERIAL_FINDER_HPP
#define ROIO_SERIAL_FINDER_HPP

#include <roio/bus.hpp>
#include <roio/parts/fd.hpp>
#include <string>

namespace roio::serial {

/// The port of the one bridge that find_bridges() finds.
/// @param stop ends it early, with what it has found by then.
/// @throws std::system_error Errc::no_bridge or several_bridges, about `name` and what was seen.
std::string find_the_bridge(const std::string& name, Timeout timeout, const EventFlag& stop);

}  // namespace roio::serial

#endif
