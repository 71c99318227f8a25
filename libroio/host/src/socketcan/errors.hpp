#ifndef ROIO_SOCKETCAN_ERRORS_HPP
#define ROIO_SOCKETCAN_ERRORS_HPP

#include <roio/bus.hpp>
#include <roio/frame.hpp>

namespace roio::socketcan {

/// What one error report of the kernel says of the controller.
struct ErrorReport {
  BusState state;        ///< After the report; the state before it when it says nothing of that.
  bool entered_bus_off;  ///< The report is that the controller went bus-off.
  bool overrun;          ///< The controller lost received frames; how many it does not say.
};

/// Decodes an error report. Pure.
/// @param frame of FrameKind::error, any content.
/// @param before the controller's state until now: active, warning, passive or bus_off.
/// Source: <linux/can/error.h>.
ErrorReport decode_error_report(const Frame& frame, BusState before) noexcept;

}  // namespace roio::socketcan

#endif
