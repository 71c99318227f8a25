/// A slower world: preloaded into programs, it makes their monotonic clock, and whatever they wait
/// by it, ROIO_SLOW_CLOCK times as slow (2..1000). A robot all of whose programs have it agrees on
/// the time, and the machine looks as many times as fast to it: for boards that keep to real time
/// beside sessions with deadlines, on a machine that has little time for them. The time of day
/// stays.
///
/// Here is what Roio and can-utils call; a program that waits by other means is not slowed down.
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <sys/select.h>
#include <unistd.h>

#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

constexpr std::int64_t second = 1'000'000'000;

std::int64_t read_factor() {
  const char* const text = std::getenv("ROIO_SLOW_CLOCK");
  const long factor = text == nullptr ? 0 : std::strtol(text, nullptr, 10);
  if (factor < 2 || factor > 1000) {
    std::fputs("slow clock: expected 2..1000 in ROIO_SLOW_CLOCK\n", stderr);
    std::abort();
  }
  return factor;
}

std::int64_t factor() {
  static const std::int64_t factor = read_factor();
  return factor;
}

std::int64_t nanoseconds(const timespec& time) {
  return time.tv_sec * second + time.tv_nsec;
}

timespec to_timespec(std::int64_t time) {
  return {time / second, time % second};
}

/// What is too long for the type stays too long.
timespec slowed(const timespec& time) {
  const bool fits = time.tv_sec < INT64_MAX / second / factor() - 1;
  return fits ? to_timespec(nanoseconds(time) * factor()) : time;
}

bool is_slow(clockid_t clock) {
  return clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_RAW ||
         clock == CLOCK_MONOTONIC_COARSE || clock == CLOCK_BOOTTIME;
}

template <typename Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const auto next = real<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = next(clock, time);
  if (result == 0 && is_slow(clock)) {
    *time = to_timespec(nanoseconds(*time) / factor());
  }
  return result;
}

int poll(pollfd* fds, nfds_t count, int timeout_ms) {
  static const auto next = real<int (*)(pollfd*, nfds_t, int)>("poll");
  const std::int64_t timeout = timeout_ms * factor();
  return next(fds, count,
              timeout_ms < 0 ? -1 : static_cast<int>(timeout < INT_MAX ? timeout : INT_MAX));
}

int ppoll(pollfd* fds, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  static const auto next =
      real<int (*)(pollfd*, nfds_t, const timespec*, const sigset_t*)>("ppoll");
  const timespec longer = timeout == nullptr ? timespec{} : slowed(*timeout);
  return next(fds, count, timeout == nullptr ? nullptr : &longer, mask);
}

int select(int count, fd_set* read, fd_set* write, fd_set* except, timeval* timeout) {
  static const auto next = real<int (*)(int, fd_set*, fd_set*, fd_set*, timeval*)>("select");
  if (timeout != nullptr) {
    const timespec longer = slowed({timeout->tv_sec, timeout->tv_usec * 1000});
    *timeout = {longer.tv_sec, longer.tv_nsec / 1000};
  }
  return next(count, read, write, except, timeout);
}

int nanosleep(const timespec* time, timespec* left) {
  static const auto next = real<int (*)(const timespec*, timespec*)>("nanosleep");
  const timespec longer = slowed(*time);
  const int result = next(&longer, left);
  if (result != 0 && left != nullptr) {
    *left = to_timespec(nanoseconds(*left) / factor());
  }
  return result;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
  static const auto next =
      real<int (*)(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
  if (!is_slow(clock) && (flags & TIMER_ABSTIME) != 0) {
    return next(clock, flags, time, left);
  }
  const timespec longer = slowed(*time);
  const int result = next(clock, flags, &longer, left);
  if (result != 0 && left != nullptr && (flags & TIMER_ABSTIME) == 0) {
    *left = to_timespec(nanoseconds(*left) / factor());
  }
  return result;
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* until) {
  static const auto next =
      real<int (*)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*)>(
          "pthread_cond_clockwait");
  const timespec later = is_slow(clock) ? slowed(*until) : *until;
  return next(condition, mutex, clock, &later);
}

}  // extern "C"
