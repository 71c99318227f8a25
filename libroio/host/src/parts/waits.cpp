#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <roio/parts/waits.hpp>
#include <system_error>

namespace roio {
namespace {

timespec to_timespec(Timeout timeout) {
  // poll() refuses what does not fit; waiting once more after a day costs nothing.
  const Timeout bounded = std::clamp<Timeout>(timeout, no_wait, std::chrono::hours(24));
  const auto seconds = std::chrono::floor<std::chrono::seconds>(bounded);
  timespec result{};
  result.tv_sec = seconds.count();
  result.tv_nsec = (bounded - seconds).count();
  return result;
}

}  // namespace

Waits::Woken Waits::wait(For first, For second, Timeout timeout) const {
  std::array<pollfd, 4> entries{{{first.fd, first.events, 0},
                                 {second.fd, second.events, 0},
                                 {cancelled_.fd(), POLLIN, 0},
                                 {closed_.fd(), POLLIN, 0}}};
  const timespec limit = to_timespec(timeout);
  const int ready = ::ppoll(entries.data(), entries.size(), &limit, nullptr);
  if (ready < 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category(), "ppoll");
  }
  if (ready < 0) {
    return {Result::ok, false};
  }
  if (entries[3].revents != 0) {
    return {Result::closed, false};
  }
  if (entries[2].revents != 0) {
    return {Result::cancelled, entries[1].revents != 0};
  }
  return {ready > 0 ? Result::ok : Result::timeout, entries[1].revents != 0};
}

}  // namespace roio
