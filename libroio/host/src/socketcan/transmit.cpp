#include "socketcan/transmit.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <roio/parts/deadline.hpp>
#include <roio/parts/frame_check.hpp>
#include <system_error>

#include "socketcan/frame.hpp"

namespace roio::socketcan {
namespace {

constexpr Timeout first_back_off = std::chrono::microseconds(50);  // about a frame at 1 Mbit/s
constexpr Timeout longest_back_off = std::chrono::milliseconds(5);
constexpr Timeout between_looks = std::chrono::milliseconds(50);

}  // namespace

Transmitter::Transmitter(Link& link, const Waits& waits, EventWatch& events)
    : link_(link), waits_(waits), events_(events), back_off_(first_back_off) {
  for (std::size_t i = 0; i < batch_size; ++i) {
    vectors_[i] = {&frames_[i], sizeof frames_[i]};
    messages_[i].msg_hdr.msg_iov = &vectors_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
  }
}

Transfer Transmitter::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  link_.look_now_and_then();
  std::size_t count = 0;
  Obstacle obstacle = offer(frames, count);
  if (obstacle == Obstacle::none) {
    return {Result::ok, count};
  }
  const Deadline deadline(timeout);
  Result woken = Result::ok;
  // Room that came together with the end of the wait is used all the same.
  while (obstacle != Obstacle::none && woken == Result::ok) {
    // What is counted goes by what was asked for, not by how late this process is by now.
    if (timeout > no_wait && obstacle != Obstacle::unusable) {
      count_wait();
    }
    woken = wait(obstacle, deadline);
    obstacle = woken == Result::closed ? obstacle : offer(frames, count);
    woken = woken == Result::ok && deadline.passed() ? Result::timeout : woken;
  }
  if (obstacle == Obstacle::none) {
    return {Result::ok, count};
  }
  if (woken == Result::timeout) {
    timeouts_.fetch_add(1, std::memory_order_relaxed);
  }
  if (woken != Result::closed) {
    events_.expect_room(obstacle);
  }
  return {woken, count};
}

Obstacle Transmitter::offer(std::span<const Frame> frames, std::size_t& count) {
  Obstacle obstacle = Obstacle::none;
  std::size_t taken = 0;
  while (obstacle == Obstacle::none && count + taken < frames.size()) {
    obstacle = offer_batch(frames.subspan(count + taken), taken);
  }
  if (taken > 0) {
    count += taken;
    sent_.fetch_add(taken, std::memory_order_relaxed);
    wait_is_counted_ = false;
    back_off_ = first_back_off;
  }
  return obstacle;
}

Obstacle Transmitter::offer_batch(std::span<const Frame> frames, std::size_t& taken) {
  if (!link_.usable()) {
    return Obstacle::unusable;
  }
  const std::size_t offered = std::min(frames.size(), batch_size);
  std::transform(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(offered),
                 frames_.begin(), to_kernel);
  const int result = ::sendmmsg(link_.socket(), messages_.data(),
                                static_cast<unsigned int>(offered), MSG_DONTWAIT);
  // The error that ended a batch early comes with the next one.
  if (result >= 0) {
    taken += static_cast<std::size_t>(result);
    return Obstacle::none;
  }
  switch (errno) {
    case EINTR:
      return Obstacle::none;
    case EAGAIN:
      return Obstacle::socket_full;
    case ENOBUFS:
      return Obstacle::queue_full;
    case ENETDOWN:
    case ENODEV:
    case ENXIO:
      // May tell of an outage that is over already; then nothing is in the way.
      link_.went_down();
      return link_.usable() ? Obstacle::none : Obstacle::unusable;
    default:
      throw std::system_error(errno, std::generic_category(), link_.name());
  }
}

void Transmitter::count_wait() {
  if (!wait_is_counted_) {
    waits_counted_.fetch_add(1, std::memory_order_relaxed);
    wait_is_counted_ = true;
  }
}

Result Transmitter::wait(Obstacle obstacle, const Deadline& deadline) {
  if (obstacle == Obstacle::unusable) {
    const Result woken = pause(between_looks, deadline);
    link_.look();
    return woken;
  }
  if (obstacle == Obstacle::socket_full) {
    return waits_.wait({link_.socket(), POLLOUT}, deadline.remaining());
  }
  const Timeout length = back_off_;
  back_off_ = std::min(2 * back_off_, longest_back_off);
  return pause(length, deadline);
}

Result Transmitter::pause(Timeout length, const Deadline& deadline) {
  const Result woken = waits_.wait({}, std::min(length, deadline.remaining()));
  return woken == Result::timeout && !deadline.passed() ? Result::ok : woken;
}

void Transmitter::fill(Statistics& statistics) const noexcept {
  statistics.sent = sent_.load(std::memory_order_relaxed);
  statistics.send_waits = waits_counted_.load(std::memory_order_relaxed);
  statistics.send_timeouts = timeouts_.load(std::memory_order_relaxed);
}

}  // namespace roio::socketcan
