#include "local/carrier_watch.hpp"

#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>

#include "local/place.hpp"

namespace roio::local {
namespace {

constexpr std::chrono::nanoseconds interval = std::chrono::milliseconds(200);

}  // namespace

CarrierWatch::CarrierWatch()
    : timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  if (!timer_) {
    throw std::system_error(errno, std::generic_category(), "timerfd");
  }
}

void CarrierWatch::begin(std::uint64_t settled) noexcept {
  if (running_) {
    return;
  }
  itimerspec once{};
  once.it_value.tv_nsec = interval.count();
  running_ = ::timerfd_settime(timer_.get(), 0, &once, nullptr) == 0;
  settled_ = settled;
}

void CarrierWatch::look(pid_t carrier, std::uint64_t settled, bool on_their_way) {
  std::uint64_t count = 0;
  static_cast<void>(!::read(timer_.get(), &count, sizeof count));
  running_ = false;
  stopped_ = on_their_way && settled == settled_ && local::is_stopped(carrier);
  if (on_their_way) {
    begin(settled);
  }
}

}  // namespace roio::local
