#ifndef ROIO_PARTS_CONTROLLER_REPORT_HPP
#define ROIO_PARTS_CONTROLLER_REPORT_HPP

#include <cstdint>
#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/frame.hpp>

namespace roio {

/// What a controller's host knows of it.
struct ControllerView {
  BusState state = BusState::active;  ///< active, warning, passive or bus_off.
  std::uint8_t transmit_errors = 0;
  std::uint8_t receive_errors = 0;
  std::uint64_t overruns = 0;
  std::uint64_t bus_offs = 0;
  std::uint64_t message_errors = 0;
};

/// Whether there is something to report: the state or a count has changed. The error counters alone
/// are nothing.
ROIO_EXPORT bool is_news(const ControllerView& before, const ControllerView& now);

/// The report as SocketCAN's drivers put it into a frame, so that one decoder does for all. Pure.
/// Source: <linux/can/error.h>.
ROIO_EXPORT Frame error_report(const ControllerView& before, const ControllerView& now);

}  // namespace roio

#endif
