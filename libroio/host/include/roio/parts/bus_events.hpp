#ifndef ROIO_PARTS_BUS_EVENTS_HPP
#define ROIO_PARTS_BUS_EVENTS_HPP

#include <atomic>
#include <cstdint>
#include <mutex>
#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/parts/fd.hpp>

namespace roio {

/// What has happened to a bus, until the program takes it: what is behind Bus::event_fd() and
/// take_events(); and the flag that a send() waits for. Any thread may call anything but look(),
/// with or without the backend's lock; none of it waits, or calls anybody. It must outlive all
/// waits. The default constructor throws std::system_error when there are no descriptors left.
class ROIO_EXPORT BusEvents {
 public:
  /// Readable while take() has something.
  [[nodiscard]] int fd() const noexcept { return told_.fd(); }
  Events take() noexcept;

  /// tell(&Events::closed). Telling what is told already changes nothing.
  void tell(bool Events::*what) noexcept;
  /// Tells state or loss when one of these is another than at the last call. To be called whenever
  /// that may be, under the backend's lock. At first a bus is active and has lost nothing.
  /// @param lost Statistics::dropped, unsent and overruns together.
  void look(BusState state, std::uint64_t lost) noexcept;
  /// Nothing has been told: for what happened before open() returned.
  void forget() noexcept { take(); }

  /// Room for frames has come: ends the waits of send(), and tells room if it is expected. After
  /// the room is there.
  void set_room() noexcept;
  /// A send() has found no room. Under the lock under which it looked.
  void clear_room() noexcept { room_.clear(); }
  /// Set while there may be room.
  [[nodiscard]] const EventFlag& room() const noexcept { return room_; }
  /// A send() has ended before it had taken all: room is told once there is some, or at once when
  /// it has come meanwhile. send_queued() calls this.
  void expect_room() noexcept;

 private:
  void tell_room() noexcept;

  EventFlag room_;
  std::atomic<bool> room_expected_{false};
  BusState state_ = BusState::active;
  std::uint64_t lost_ = 0;
  EventFlag told_;  // while pending_ has any
  std::mutex mutex_;
  Events pending_;
};

}  // namespace roio

#endif
