#ifndef ROIO_LOCAL_POLLER_HPP
#define ROIO_LOCAL_POLLER_HPP

#include <sys/epoll.h>
#include <array>
#include <chrono>
#include <cstddef>
#include <roio/parts/fd.hpp>
#include <span>

namespace roio::local {

/// Waits for any of many descriptors to be readable, at the cost of those that are.
class Poller {
 public:
  Poller();  ///< @throws std::system_error when there are no descriptors left.

  /// @param tag what wait() returns for it; not null. @throws std::system_error.
  void add(int fd, void* tag);
  /// Not needed for a descriptor that has been closed, unless another has the same open file.
  void remove(int fd) noexcept;

  /// The tags of those that are readable, or whose other end is gone; more may be the next time.
  /// Valid until the next call. @param timeout to the nanosecond; not negative.
  std::span<void* const> wait(std::chrono::nanoseconds timeout) noexcept;

 private:
  static constexpr std::size_t most_at_once = 64;

  UniqueFd epoll_;
  std::array<epoll_event, most_at_once> events_{};
  std::array<void*, most_at_once> tags_{};
};

}  // namespace roio::local

#endif
