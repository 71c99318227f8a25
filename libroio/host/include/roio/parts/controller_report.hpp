/// A controller's state and counters as an error report, for backends whose carrier tells numbers
/// and not events. Pure functions: any thread, no errors, nothing kept.
///
///   const ControllerView last = std::exchange(view_, read_the_controller());
///   if (is_news(last, view_) && options.error_frames) {
///     queue_.put(error_report(last, view_), now);
///   }
#ifndef ROIO_PARTS_CONTROLLER_REPORT_HPP
#define ROIO_PARTS_CONTROLLER_REPORT_HPP

#include <cstdint>
#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/frame.hpp>

namespace roio {

/// What a controller's host knows of it. The default is a controller that nothing has happened to.
struct ControllerView {
  BusState state = BusState::active;  ///< active, warning, passive or bus_off.
  std::uint8_t transmit_errors = 0;   ///< TEC.
  std::uint8_t receive_errors = 0;    ///< REC.
  // Since an arbitrary start; they only grow.
  std::uint64_t overruns = 0;        ///< Times that it lost frames, how many unsaid.
  std::uint64_t bus_offs = 0;        ///< Times that it went bus-off.
  std::uint64_t message_errors = 0;  ///< Times that it found an error in a frame.
};

/// Whether there is something to report: the state or a count has changed. The error counters alone
/// are nothing.
ROIO_EXPORT bool is_news(const ControllerView& before, const ControllerView& now);

/// The report as SocketCAN's drivers put it into a frame, so that one decoder does for all.
/// @return of FrameKind::error and 8 bytes: bytes 6 and 7 are TEC and REC as they are now. Without
///         news it is a report of these alone.
/// Source: <linux/can/error.h>.
ROIO_EXPORT Frame error_report(const ControllerView& before, const ControllerView& now);

}  // namespace roio

#endif
