#include "local/poller.hpp"

#include <poll.h>

#include <cerrno>
#include <ctime>
#include <system_error>

namespace roio::local {

Poller::Poller() : epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  if (!epoll_) {
    throw std::system_error(errno, std::generic_category(), "epoll");
  }
}

void Poller::add(int fd, void* tag) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.ptr = tag;
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) != 0) {
    throw std::system_error(errno, std::generic_category(), "epoll");
  }
}

void Poller::remove(int fd) noexcept {
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, fd, nullptr);
}

std::span<void* const> Poller::wait(std::chrono::nanoseconds timeout) noexcept {
  if (timeout.count() > 0) {
    constexpr std::int64_t second = 1'000'000'000;
    const timespec spec{static_cast<time_t>(timeout.count() / second),
                        static_cast<long>(timeout.count() % second)};
    pollfd entry{epoll_.get(), POLLIN, 0};
    // A failed poll (a signal, no memory) is just an early wake-up.
    static_cast<void>(::ppoll(&entry, 1, &spec, nullptr));
  }
  const int count = ::epoll_wait(epoll_.get(), events_.data(), most_at_once, 0);
  std::size_t ready = 0;
  for (int i = 0; i < count; ++i) {
    tags_.at(ready++) = events_.at(static_cast<std::size_t>(i)).data.ptr;
  }
  return std::span(tags_).first(ready);
}

}  // namespace roio::local
