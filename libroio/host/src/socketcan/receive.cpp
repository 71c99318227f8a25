#include "socketcan/receive.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <roio/parts/deadline.hpp>
#include <system_error>
#include <utility>

#include "socketcan/frame.hpp"

namespace roio::socketcan {

Receiver::Receiver(Link& link, const Waits& waits, bool error_frames)
    : link_(link), waits_(waits), error_frames_(error_frames) {
  for (std::size_t i = 0; i < batch_size; ++i) {
    vectors_[i] = {&frames_[i], sizeof frames_[i]};
    messages_[i].msg_hdr.msg_iov = &vectors_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
    messages_[i].msg_hdr.msg_control = controls_[i].bytes.data();
  }
}

Transfer Receiver::receive(std::span<Received> frames, Timeout timeout) {
  if (frames.empty()) {
    return {Result::timeout, 0};
  }
  std::size_t count = take(frames);
  if (count == 0) {
    const Deadline deadline(timeout);
    Result woken = Result::ok;
    // What came in together with the end of the wait is taken all the same. Error reports, CAN FD
    // frames and news of other interfaces end a poll() too, but must not keep the call beyond its
    // deadline.
    while (count == 0 && woken == Result::ok) {
      woken = wait(deadline.remaining());
      count = woken == Result::closed ? 0 : take(frames);
      woken = woken == Result::ok && deadline.passed() ? Result::timeout : woken;
    }
    if (count == 0) {
      return {woken, 0};
    }
  }
  return {Result::ok, count};
}

Result Receiver::wait(Timeout timeout) {
  const auto woken = waits_.wait({link_.socket(), POLLIN}, {link_.news(), POLLIN}, timeout);
  if (woken.second_ready) {
    link_.read_news();
  }
  return woken.result;
}

std::size_t Receiver::take(std::span<Received> frames) {
  std::size_t count = 0;
  while (count < frames.size()) {
    const std::size_t wanted = std::min(frames.size() - count, batch_size);
    const std::size_t taken = take_batch(wanted);
    for (std::size_t slot = 0; slot < taken; ++slot) {
      count += accept(slot, frames[count]) ? 1U : 0U;
    }
    taken_in_a_row_ += taken;
    if (taken < wanted) {
      note_end_of_queue();
      break;
    }
  }
  return count;
}

// What finds the queue full, at its end no frame tells of. A queue of one frame was not full.
void Receiver::note_end_of_queue() {
  if (std::exchange(taken_in_a_row_, 0) > 1) {
    link_.count_lost();
  }
}

std::size_t Receiver::take_batch(std::size_t wanted) {
  for (std::size_t i = 0; i < wanted; ++i) {
    messages_[i].msg_hdr.msg_controllen = control_bytes;
  }
  for (;;) {
    const int taken = ::recvmmsg(link_.socket(), messages_.data(),
                                 static_cast<unsigned int>(wanted), MSG_DONTWAIT, nullptr);
    if (taken >= 0) {
      return static_cast<std::size_t>(taken);
    }
    switch (errno) {
      case EAGAIN:
        return 0;
      case EINTR:
        break;
      case ENETDOWN:
      case ENODEV:
        link_.went_down();
        break;
      default:
        throw std::system_error(errno, std::generic_category(), link_.name());
    }
  }
}

bool Receiver::accept(std::size_t slot, Received& received) {
  const mmsghdr& message = messages_[slot];
  read_control(message.msg_hdr, received.time);
  // The one thing that is longer.
  if ((message.msg_hdr.msg_flags & MSG_TRUNC) != 0) {
    fd_frames_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  if (message.msg_len != sizeof(can_frame)) {
    return false;
  }
  received.frame = from_kernel(frames_[slot]);
  if (received.frame.kind == FrameKind::error) {
    link_.report(received.frame);
    if (!error_frames_) {
      return false;
    }
  } else {
    received_.fetch_add(1, std::memory_order_relaxed);
  }
  received.lost_before = std::exchange(lost_before_, 0);
  return true;
}

void Receiver::read_control(const msghdr& header, Timestamp& time) {
  timespec stamp{};
  // CMSG_NXTHDR takes no const pointer.
  auto* walked = const_cast<msghdr*>(&header);
  for (cmsghdr* item = CMSG_FIRSTHDR(walked); item != nullptr; item = CMSG_NXTHDR(walked, item)) {
    if (item->cmsg_level != SOL_SOCKET) {
      continue;
    }
    if (item->cmsg_type == SCM_TIMESTAMPNS) {
      std::memcpy(&stamp, CMSG_DATA(item), sizeof stamp);
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t drops = 0;
      std::memcpy(&drops, CMSG_DATA(item), sizeof drops);
      lost_before_ += static_cast<std::uint32_t>(drops - drops_);
      drops_ = drops;
    }
  }
  time = Timestamp(std::chrono::seconds(stamp.tv_sec) + std::chrono::nanoseconds(stamp.tv_nsec));
}

void Receiver::fill(Statistics& statistics) const noexcept {
  statistics.received = received_.load(std::memory_order_relaxed);
  statistics.fd_frames = fd_frames_.load(std::memory_order_relaxed);
}

}  // namespace roio::socketcan
