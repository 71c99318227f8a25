#ifndef ROIO_LOCAL_CARRIER_WATCH_HPP
#define ROIO_LOCAL_CARRIER_WATCH_HPP

#include <sys/types.h>

#include <cstdint>
#include <roio/parts/fd.hpp>

namespace roio::local {

/// Notices that the process which carries the bus has been stopped: while frames are on their way
/// it looks every 200 ms whether there was progress, and if not, at the process. While none are it
/// costs nothing. The caller holds the bus's lock.
class CarrierWatch {
 public:
  CarrierWatch();  ///< @throws std::system_error: no descriptors left.

  /// Frames are on their way. @param settled how many have arrived since the beginning.
  void begin(std::uint64_t settled) noexcept;
  /// Another carrier; nothing is known of it.
  void reset() noexcept { stopped_ = false; }

  /// Readable when look() is due.
  [[nodiscard]] int fd() const noexcept { return timer_.get(); }
  /// fd() was readable.
  void look(pid_t carrier, std::uint64_t settled, bool on_their_way);
  [[nodiscard]] bool is_stopped() const noexcept { return stopped_; }

 private:
  UniqueFd timer_;
  bool running_ = false;
  bool stopped_ = false;
  std::uint64_t settled_ = 0;  // when the timer began
};

}  // namespace roio::local

#endif
