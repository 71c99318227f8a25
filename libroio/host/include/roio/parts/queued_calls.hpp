/// The course of Bus::send() and Bus::receive() where another thread serves queues: the same for
/// all such buses, whatever is behind the queues. They wait without any lock; what they are given
/// is called in the calling thread and takes the backend's lock by itself. What that throws, they
/// throw.
#ifndef ROIO_PARTS_QUEUED_CALLS_HPP
#define ROIO_PARTS_QUEUED_CALLS_HPP

#include <poll.h>

#include <cstddef>
#include <optional>
#include <roio/bus.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/fd.hpp>
#include <roio/parts/waits.hpp>
#include <span>

namespace roio {

/// Bus::receive(): takes what there is; when that is nothing, waits for the first.
/// @param readable set while there may be some: ReceiveQueue::readable().
/// @param frames where to; empty: looks whether the bus is closed or cancelled, and does not wait.
/// @param take std::optional<std::size_t>(std::span<Received>): how many frames it has taken, 0
/// when
///        there are none and `readable` is clear; none: the bus is closed. Called once or more.
/// @return as the contract has it: what is there is given even when the bus is cancelled.
template <typename Take>
Transfer receive_queued(const Waits& waits, const EventFlag& readable, std::span<Received> frames,
                        Timeout timeout, const Take& take) {
  const Deadline deadline(timeout);
  for (;;) {
    const bool cancelled = waits.is_cancelled();  // before it looks: what is there then is given
    const std::optional<std::size_t> count = take(frames);
    if (!count) {
      return {Result::closed, 0};
    }
    if (*count > 0) {
      return {Result::ok, *count};
    }
    if (cancelled || frames.empty() || deadline.passed()) {
      return {cancelled ? Result::cancelled : Result::timeout, 0};
    }
    static_cast<void>(waits.wait({readable.fd(), POLLIN}, deadline.remaining()));
  }
}

/// Bus::send(): offers the frames, and those left over again whenever there may be room.
/// @param frames checked already: check_sendable().
/// @param offer std::optional<std::size_t>(std::span<const Frame>): how many of the frames it has
///        accepted, from the first; none: the bus is closed. If not all, it has called
///        BusEvents::clear_room(), under the lock under which it found none; who makes room calls
///        set_room(). Called once or more.
/// @param count void(bool): told each time that it waits (false), and when it gives up at its
///        deadline (true), for Statistics::send_waits and send_timeouts.
/// @return ok when all were accepted; else the first Transfer::count were, and `events` tells when
///         there is room for more.
template <typename Offer, typename Count>
Transfer send_queued(const Waits& waits, BusEvents& events, std::span<const Frame> frames,
                     Timeout timeout, const Offer& offer, const Count& count) {
  const Deadline deadline(timeout);
  // Once at least, however late this process may be by now: what is counted goes by what was asked.
  bool may_wait = timeout > no_wait;
  std::size_t sent = 0;
  for (;;) {
    const std::optional<std::size_t> accepted = offer(frames.subspan(sent));
    if (!accepted) {
      return {Result::closed, sent};
    }
    sent += *accepted;
    if (sent == frames.size()) {
      return {Result::ok, sent};
    }
    if (waits.is_cancelled()) {
      events.expect_room();
      return {Result::cancelled, sent};
    }
    count(!may_wait);
    if (!may_wait) {
      events.expect_room();
      return {Result::timeout, sent};
    }
    static_cast<void>(waits.wait({events.room().fd(), POLLIN}, deadline.remaining()));
    may_wait = !deadline.passed();
  }
}

}  // namespace roio

#endif
