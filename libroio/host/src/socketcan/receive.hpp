#ifndef ROIO_SOCKETCAN_RECEIVE_HPP
#define ROIO_SOCKETCAN_RECEIVE_HPP

#include <linux/can.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <roio/bus.hpp>
#include <roio/parts/waits.hpp>
#include <span>

#include "socketcan/link.hpp"

namespace roio::socketcan {

/// The receiving side of a link, for one thread at a time (fill() for any).
class Receiver {
 public:
  Receiver(Link& link, const Waits& waits, bool error_frames);

  /// Bus::receive().
  Transfer receive(std::span<Received> frames, Timeout timeout);

  /// Writes received and fd_frames.
  void fill(Statistics& statistics) const noexcept;

 private:
  static constexpr std::size_t batch_size = 64;  // frames in one system call
  static constexpr std::size_t control_bytes =
      CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));

  struct alignas(cmsghdr) Control {
    std::array<unsigned char, control_bytes> bytes;
  };

  [[nodiscard]] Result wait(Timeout timeout);
  [[nodiscard]] std::size_t take(std::span<Received> frames);
  [[nodiscard]] std::size_t take_batch(std::size_t wanted);
  void note_end_of_queue();
  [[nodiscard]] bool accept(std::size_t slot, Received& received);
  void read_control(const msghdr& header, Timestamp& time);

  Link& link_;
  const Waits& waits_;
  const bool error_frames_;
  std::array<can_frame, batch_size> frames_{};
  std::array<iovec, batch_size> vectors_{};
  std::array<Control, batch_size> controls_{};
  std::array<mmsghdr, batch_size> messages_{};
  std::size_t taken_in_a_row_ = 0;  // since the queue was empty
  std::uint32_t drops_ = 0;         // the kernel's count with the last frame
  std::uint64_t lost_before_ = 0;   // owed to the next frame that is returned
  std::atomic<std::uint64_t> received_{0};
  std::atomic<std::uint64_t> fd_frames_{0};
};

}  // namespace roio::socketcan

#endif
