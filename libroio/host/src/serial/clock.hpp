#ifndef ROIO_SERIAL_CLOCK_HPP
#define ROIO_SERIAL_CLOCK_HPP

#include <chrono>
#include <cstdint>

namespace roio::serial {

/// Time on the PC, since an arbitrary zero; it never goes back.
using Time = std::chrono::nanoseconds;

/// The bridge's time told by the PC's clock. A frame has 16 bits of it, that is a quarter of a
/// second; STATUS has 32, often enough to tell which quarter.
///
/// How far apart the clocks are is taken from the record that was the shortest time under way: the
/// least difference between arrival and bridge's time, which may grow by a hundredth of the time
/// gone by, more than any crystal or resonator is off.
class BridgeClock {
 public:
  /// Another session: the bridge may have been reset.
  void begin() { known_ = false; }

  /// @return false: it goes back, which no bridge's time does; nothing was changed.
  bool status(std::uint32_t ticks, Time arrival);

  /// When the bridge read the frame; the time of arrival, as long as nothing better is known. Not
  /// after the arrival, and not before the time told last.
  Time frame(std::uint16_t ticks, Time arrival);

 private:
  void correct(Time arrival);

  std::int64_t ticks_ = 0;  // of the record last seen, as many bits as it takes
  bool known_ = false;      // a STATUS of this session has come
  Time offset_{0};          // of the PC's clock from the bridge's
  Time corrected_at_{0};
  Time last_{0};
};

}  // namespace roio::serial

#endif
