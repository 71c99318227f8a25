#include "socketcan/event_watch.hpp"

#include <sys/epoll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <system_error>

namespace roio::socketcan {
namespace {

constexpr std::chrono::nanoseconds queue_time = std::chrono::milliseconds(5);

}  // namespace

EventWatch::EventWatch(Link& link, BusEvents& events)
    : link_(link),
      events_(events),
      watcher_(::epoll_create1(EPOLL_CLOEXEC)),
      timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  watch(events_.fd());
  watch(link_.news());
  watch(timer_.get());
}

void EventWatch::watch(int fd) {
  epoll_event event{};
  event.events = fd == link_.socket() ? EPOLLOUT : EPOLLIN;
  event.data.fd = fd;
  // EEXIST: an earlier send() waits for the same, and has not been told yet.
  if (::epoll_ctl(watcher_.get(), EPOLL_CTL_ADD, fd, &event) != 0 && errno != EEXIST) {
    throw std::system_error(errno, std::generic_category(), link_.name());
  }
}

void EventWatch::unwatch(int fd) noexcept {
  epoll_event unused{};
  static_cast<void>(::epoll_ctl(watcher_.get(), EPOLL_CTL_DEL, fd, &unused));
}

void EventWatch::expect_room(Obstacle obstacle) {
  if (obstacle == Obstacle::socket_full) {
    watch(link_.socket());
  } else if (obstacle == Obstacle::queue_full) {
    itimerspec once{};
    once.it_value.tv_nsec = queue_time.count();
    ::timerfd_settime(timer_.get(), 0, &once, nullptr);
  } else {
    events_.expect_room();
  }
}

Events EventWatch::take() {
  std::array<epoll_event, 4> ready{};
  const int count = ::epoll_wait(watcher_.get(), ready.data(), static_cast<int>(ready.size()), 0);
  for (int i = 0; i < count; ++i) {
    const int fd = ready.at(static_cast<std::size_t>(i)).data.fd;
    if (fd == link_.news()) {
      link_.read_news();
    } else if (fd == link_.socket()) {
      unwatch(fd);
      may_have_room();
    } else if (fd == timer_.get()) {
      std::uint64_t rings = 0;
      static_cast<void>(!::read(fd, &rings, sizeof rings));
      may_have_room();
    }
  }
  return events_.take();
}

// An interface that has gone meanwhile ends the wait, too.
void EventWatch::may_have_room() {
  link_.look();
  if (link_.usable()) {
    events_.tell(&Events::room);
  } else {
    events_.expect_room();
  }
}

}  // namespace roio::socketcan
