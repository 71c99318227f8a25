#ifndef ROIO_SOCKETCAN_TRANSMIT_HPP
#define ROIO_SOCKETCAN_TRANSMIT_HPP

#include <linux/can.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <roio/bus.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/waits.hpp>
#include <span>

#include "socketcan/event_watch.hpp"
#include "socketcan/link.hpp"

namespace roio::socketcan {

/// The sending side of a link, for one thread at a time (fill() for any).
class Transmitter {
 public:
  Transmitter(Link& link, const Waits& waits, EventWatch& events);

  /// Bus::send().
  Transfer send(std::span<const Frame> frames, Timeout timeout);

  /// Writes sent, send_waits and send_timeouts.
  void fill(Statistics& statistics) const noexcept;

 private:
  static constexpr std::size_t batch_size = 32;  // frames in one system call

  /// Offers the frames from `count` on; moves it past those that were taken.
  [[nodiscard]] Obstacle offer(std::span<const Frame> frames, std::size_t& count);
  /// Offers at most a batch; adds those that were taken. none: offer the rest.
  [[nodiscard]] Obstacle offer_batch(std::span<const Frame> frames, std::size_t& taken);
  void count_wait();
  /// Waits until trying again makes sense (ok), or must not be done.
  [[nodiscard]] Result wait(Obstacle obstacle, const Deadline& deadline);
  [[nodiscard]] Result pause(Timeout length, const Deadline& deadline);

  Link& link_;
  const Waits& waits_;
  EventWatch& events_;
  std::array<can_frame, batch_size> frames_{};
  std::array<iovec, batch_size> vectors_{};
  std::array<mmsghdr, batch_size> messages_{};
  Timeout back_off_;              // the next pause while an interface's queue is full
  bool wait_is_counted_ = false;  // several pauses for one frame are one wait
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> waits_counted_{0};
  std::atomic<std::uint64_t> timeouts_{0};
};

}  // namespace roio::socketcan

#endif
