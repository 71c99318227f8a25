#ifndef ROIO_SOCKETCAN_EVENT_WATCH_HPP
#define ROIO_SOCKETCAN_EVENT_WATCH_HPP

#include <roio/bus.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/fd.hpp>

#include "socketcan/link.hpp"

namespace roio::socketcan {

/// Why the kernel took no more frames.
enum class Obstacle : std::uint8_t {
  none,
  socket_full,  ///< poll() tells when there is room.
  queue_full,   ///< The interface's queue, filled by others too: nothing tells.
  unusable,     ///< No interface, or it is down or bus-off.
};

/// Bus::event_fd() and take_events() of a bus that has no thread: one descriptor for what is told
/// by others, for news of interfaces, and for room where a send() has found none. Any thread.
class EventWatch {
 public:
  /// @throws std::system_error: no descriptors left.
  EventWatch(Link& link, BusEvents& events);

  [[nodiscard]] int fd() const noexcept { return watcher_.get(); }
  Events take();

  /// A send() has ended at this: tells room once it may be gone.
  void expect_room(Obstacle obstacle);

 private:
  void watch(int fd);
  void unwatch(int fd) noexcept;
  void may_have_room();

  Link& link_;
  BusEvents& events_;
  UniqueFd watcher_;
  UniqueFd timer_;  // to ask again for room in a queue that tells nobody
};

}  // namespace roio::socketcan

#endif
