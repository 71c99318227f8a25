/// What the host library throws: std::system_error, with these codes or the system's own.
/// what() is one line, "<what it is about>: <what is wrong and what was expected>".
#ifndef ROIO_ERROR_HPP
#define ROIO_ERROR_HPP

#include <system_error>

#include <roio/export.hpp>

namespace roio {

enum class Errc {
  bad_url = 1,          ///< The text names no bus.
  no_such_interface,    ///< No network interface of that name.
  not_a_can_interface,  ///< The interface exists and is not CAN.
  no_can_support,       ///< The kernel has no CAN; a local bus needs none.
  not_supported,        ///< This build has no such kind of bus.
  bitrate_mismatch,     ///< The local bus already runs at another bit rate.
  version_mismatch,     ///< The local bus, or the bridge, is run by an incompatible version.
  not_permitted,        ///< The local bus, or its folder, is not this user's alone.
  too_many_filters,     ///< More filters than the backend takes.
  bad_frame,            ///< A frame that no bus carries: id, length or kind out of range.
  not_connected,        ///< The local bus could not be reached or taken over in time.
  carrier_stopped,      ///< The program that carries the local bus has been stopped (Ctrl-Z).
  carried_already,      ///< Another program is there to carry the local bus, always.
  bus_full,             ///< The local bus has as many programs as it takes.
  no_such_port,         ///< No serial port of that name.
  not_a_port,           ///< It exists and is no serial port.
  port_in_use,          ///< Another program has the serial port.
  port_not_permitted,   ///< This user may not open the serial port.
  no_bridge,            ///< No bridge answered in time, or none was found.
  several_bridges,      ///< serial:auto, and there is more than one.
  bridge_refused,       ///< The bridge answered that it cannot do that.
  relative_path,  ///< An environment variable names a file by a path that begins elsewhere than at
                  ///< /.
};

ROIO_EXPORT const std::error_category& error_category() noexcept;

inline std::error_code make_error_code(Errc code) noexcept {
  return {static_cast<int>(code), error_category()};
}

}  // namespace roio

template <>
struct std::is_error_code_enum<roio::Errc> : std::true_type {};

#endif
