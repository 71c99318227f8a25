#include <roio/error.hpp>
#include <string>

namespace roio {
namespace {

class Category final : public std::error_category {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "roio"; }

  [[nodiscard]] std::string message(int code) const override {
    switch (static_cast<Errc>(code)) {
      case Errc::bad_url:
        return "not the name of a bus";
      case Errc::no_such_interface:
        return "no such network interface; `ip link` lists them, and local:NAME needs none";
      case Errc::not_a_can_interface:
        return "not a CAN interface; `ip link show type can` lists those, and local:NAME needs "
               "none";
      case Errc::no_can_support:
        return "this kernel has no CAN; try `modprobe can_raw`, or local:NAME, which needs none";
      case Errc::not_supported:
        return "this version of Roio cannot open such a bus";
      case Errc::bitrate_mismatch:
        return "not the pace of this bus; its name alone, without bitrate, joins it as it is";
      case Errc::version_mismatch:
        return "the bus is run by an incompatible version of Roio";
      case Errc::not_permitted:
        return "local buses are for one user alone";
      case Errc::too_many_filters:
        return "too many filters; a bus takes 512";
      case Errc::bad_frame:
        return "no frame that a CAN bus carries";
      case Errc::not_connected:
        return "nobody carries it, or not in time";
      case Errc::carrier_stopped:
        return "it carries the bus and has been stopped; `fg` or `kill -CONT` lets it go on";
      case Errc::carried_already:
        return "another program is there to carry it";
      case Errc::bus_full:
        return "256 programs are on the bus, as many as it takes";
      case Errc::no_such_port:
        return "no such serial port; `ls /dev/ttyACM* /dev/ttyUSB*` lists those that are plugged "
               "in, and serial:auto finds a bridge among them";
      case Errc::not_a_port:
        return "not a serial port; expected one such as /dev/ttyACM0";
      case Errc::port_in_use:
        return "another program has the port open; `fuser -v` with the port's name tells which";
      case Errc::port_not_permitted:
        return "no permission to open the port";
      case Errc::no_bridge:
        return "no bridge answered in time; is the board plugged in, and bridge_usb on it? "
               "`scripts/flash` puts it there";
      case Errc::several_bridges:
        return "more than one bridge; say which one, such as serial:/dev/ttyACM0";
      case Errc::bridge_refused:
        return "the bridge refused";
      case Errc::relative_path:
        return "expected a path that begins with /";
    }
    return "unknown Roio error " + std::to_string(code);
  }
};

}  // namespace

const std::error_category& error_category() noexcept {
  static const Category category;
  return category;
}

}  // namespace roio
