/// Tally: all that the bridge counts, in the order of COUNTERS in
/// docs/internals/serial-protocol.md.
#ifndef ROIO_BRIDGE_TALLY_H
#define ROIO_BRIDGE_TALLY_H

#include "can_side.h"
#include "line.h"

namespace roio {
namespace bridge {

class Tally {
 public:
  Tally(const CanSide& can, Line& line)
      : dropped(0), damaged(0), refused(0), can_(can), line_(line) {}

  /// @param index 0..counter_count - 1.
  uint32_t value(uint8_t index) {
    const auto driver = can_.counters();
    switch (index) {
      case 0:
        return dropped;
      case 1:
        return driver.overflows;
      case 2:
        return driver.sent;
      case 3:
        return driver.not_sent + refused;
      case 4:
        return driver.unknown;
      case 5:
        return driver.bus_offs;
      case 6:
        return driver.message_errors;
      case 7:
        return driver.chip_losses;
      case 8:
        return driver.discarded;
      case 9:
        return damaged;
      default:
        return line_.overruns();
    }
  }

  uint32_t dropped;  ///< Frames for the PC that found no room.
  uint32_t damaged;  ///< Records from the PC.
  uint32_t refused;  ///< Frames from the PC that came too late, or while the bridge only listens.

 private:
  const CanSide& can_;
  Line& line_;
};

}  // namespace bridge
}  // namespace roio

#endif
