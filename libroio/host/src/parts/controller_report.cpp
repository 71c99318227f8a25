#include <roio/parts/controller_report.hpp>

namespace roio {
namespace {

// The classes of <linux/can/error.h>, in the identifier.
constexpr std::uint32_t class_controller = 0x004;
constexpr std::uint32_t class_protocol = 0x008;
constexpr std::uint32_t class_bus_off = 0x040;
constexpr std::uint32_t class_bus_error = 0x080;
constexpr std::uint32_t class_restarted = 0x100;
constexpr std::uint32_t class_counters = 0x200;

// What is wrong with the controller, in byte 1.
constexpr std::uint8_t receive_overflow = 0x01;
constexpr std::uint8_t receive_warning = 0x04;
constexpr std::uint8_t transmit_warning = 0x08;
constexpr std::uint8_t receive_passive = 0x10;
constexpr std::uint8_t transmit_passive = 0x20;
constexpr std::uint8_t active_again = 0x40;

constexpr std::uint8_t warning_level = 96;
constexpr std::uint8_t passive_level = 128;

struct Report {
  std::uint32_t classes = class_counters;
  std::uint8_t controller = 0;

  void add(std::uint8_t flag) {
    classes |= class_controller;
    controller = static_cast<std::uint8_t>(controller | flag);
  }
  void add_side(const ControllerView& now, std::uint8_t level, std::uint8_t transmit,
                std::uint8_t receive) {
    if (now.transmit_errors >= level) {
      add(transmit);
    }
    // By the time that the counters were read, both may be below: then it was the receiver's, which
    // falls fastest.
    if (now.receive_errors >= level || now.transmit_errors < level) {
      add(receive);
    }
  }
  void add_state(const ControllerView& before, const ControllerView& now) {
    switch (now.state) {
      case BusState::bus_off:
        classes |= class_bus_off;
        break;
      case BusState::passive:
        add_side(now, passive_level, transmit_passive, receive_passive);
        break;
      case BusState::warning:
        add_side(now, warning_level, transmit_warning, receive_warning);
        break;
      default:
        add(active_again);
        break;
    }
    if (before.state == BusState::bus_off) {
      classes |= class_restarted;
    }
  }
};

}  // namespace

bool is_news(const ControllerView& before, const ControllerView& now) {
  return before.state != now.state || before.overruns != now.overruns ||
         before.bus_offs != now.bus_offs || before.message_errors != now.message_errors;
}

Frame error_report(const ControllerView& before, const ControllerView& now) {
  Report report;
  if (before.state != now.state) {
    report.add_state(before, now);
  }
  if (before.bus_offs != now.bus_offs) {
    report.classes |= class_bus_off;
  }
  if (before.overruns != now.overruns) {
    report.add(receive_overflow);
  }
  if (before.message_errors != now.message_errors) {
    report.classes |= class_protocol | class_bus_error;
  }
  return {report.classes,
          FrameKind::error,
          max_data_length,
          {0, report.controller, 0, 0, 0, 0, now.transmit_errors, now.receive_errors}};
}

}  // namespace roio
