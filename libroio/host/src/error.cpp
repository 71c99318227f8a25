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
        return "not a bus; expected an interface such as can0, or local:NAME";
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
        return "the bus already runs at another bit rate";
      case Errc::version_mismatch:
        return "the bus is run by an incompatible version of Roio";
      case Errc::not_permitted:
        return "local buses are for one user alone";
      case Errc::too_many_filters:
        return "too many filters; a bus takes 512";
      case Errc::bad_frame:
        return "no frame that a CAN bus carries";
      case Errc::not_connected:
        return "no hub answered, and none could be started, in time";
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
