#include "socketcan/link.hpp"

#include <cerrno>
#include <roio/error.hpp>
#include <system_error>
#include <utility>

#include "socketcan/errors.hpp"
#include "socketcan/socket.hpp"

namespace roio::socketcan {

namespace {

/// What is wrong with an interface that was found; none: nothing.
std::optional<Errc> trouble_with(const InterfaceLook& found) {
  if (found.index == 0) {
    return Errc::no_such_interface;
  }
  return found.is_can ? std::nullopt : std::optional(Errc::not_a_can_interface);
}

}  // namespace

Link::Link(std::string name, std::span<const SocketCanFilter> filters, BusEvents& events,
           bool may_be_absent)
    : name_(std::move(name)),
      events_(events),
      socket_(make_socket(name_)),
      news_(make_news_socket(name_)),
      filters_(filters.begin(), filters.end()) {
  const InterfaceLook found = look_at(socket(), name_);
  const auto trouble = trouble_with(found);
  if (trouble && !may_be_absent) {
    throw std::system_error(*trouble, name_);
  }
  int error = apply_filters(socket(), filters_);
  if (error == 0 && !trouble) {
    error = bind_to(socket(), found.index);
  }
  if (error != 0) {
    throw std::system_error(error, std::generic_category(), name_);
  }
  // An interface that is down from the start is no outage; binding to it leaves an error behind.
  interface_ = found.up && !trouble ? Interface::up : Interface::down;
  static_cast<void>(take_error(socket()));
  look();
  events_.forget();
}

void Link::look() {
  const std::lock_guard lock(mutex_);
  look_locked();
}

void Link::look_now_and_then() {
  constexpr Clock::duration recent = std::chrono::milliseconds(100);
  const Clock::duration age =
      Clock::now().time_since_epoch() - Clock::duration(last_look_.load(std::memory_order_relaxed));
  if (age >= recent) {
    look();
  }
}

void Link::went_down() {
  const std::lock_guard lock(mutex_);
  set_interface(Interface::down);
  look_locked();
}

void Link::read_news() {
  discard_news(news());
  look();
}

BusState Link::state() {
  const std::lock_guard lock(mutex_);
  look_locked();
  return state_locked();
}

std::optional<std::system_error> Link::trouble() {
  const std::lock_guard lock(mutex_);
  look_locked();
  const auto trouble = trouble_with(look_at(socket(), name_));
  return trouble ? std::optional(std::system_error(*trouble, name_)) : std::nullopt;
}

BusState Link::state_locked() const {
  switch (interface_) {
    case Interface::up:
      return controller_;
    case Interface::down:
      return BusState::down;
    case Interface::absent:
      break;
  }
  return BusState::absent;
}

void Link::look_locked() {
  last_look_.store(Clock::now().time_since_epoch().count(), std::memory_order_relaxed);
  // The error tells of an outage that is over already.
  const int error = take_error(socket());
  if (error == ENETDOWN || error == ENODEV) {
    set_interface(Interface::down);
  }
  const InterfaceLook found = look_at(socket(), name_);
  if (found.index == 0 || !found.is_can || !bind_locked(found.index)) {
    set_interface(Interface::absent);
  } else {
    set_interface(found.up ? Interface::up : Interface::down);
  }
  // A carrier that is back means a controller that was restarted, should its report have been lost.
  if (found.carrier && !carrier_) {
    controller_ = BusState::active;
  }
  carrier_ = found.carrier;
  update_usable();
  tell_news();
}

bool Link::bind_locked(int interface_index) {
  if (bound_interface(socket()) == interface_index) {
    return true;
  }
  // The kernel forgot the filters together with the interface.
  if (apply_filters(socket(), filters_) != 0 || bind_to(socket(), interface_index) != 0) {
    return false;
  }
  controller_ = BusState::active;
  return true;
}

void Link::set_interface(Interface now) {
  if (interface_ == Interface::up && now != Interface::up) {
    ++outages_;
  }
  if (interface_ != Interface::up && now == Interface::up) {
    controller_ = BusState::active;
  }
  interface_ = now;
}

void Link::update_usable() {
  const bool usable = interface_ == Interface::up && carrier_ && controller_ != BusState::bus_off;
  if (usable_.exchange(usable, std::memory_order_relaxed) == usable) {
    return;
  }
  if (usable) {
    events_.set_room();
  } else {
    events_.clear_room();
  }
}

void Link::tell_news() {
  events_.look(state_locked(), dropped_ + overruns_);
}

void Link::report(const Frame& error) {
  const std::lock_guard lock(mutex_);
  const ErrorReport report = decode_error_report(error, controller_);
  ++error_frames_;
  bus_offs_ += report.entered_bus_off ? 1U : 0U;
  overruns_ += report.overrun ? 1U : 0U;
  controller_ = report.state;
  update_usable();
  tell_news();
}

void Link::set_filters(std::span<const SocketCanFilter> filters) {
  const std::lock_guard lock(mutex_);
  if (muted_) {
    return;
  }
  std::vector<SocketCanFilter> kept(filters.begin(), filters.end());
  const int error = apply_filters(socket(), kept);
  // ENODEV: the interface has just gone; the next one gets them.
  if (error != 0 && error != ENODEV) {
    throw std::system_error(error, std::generic_category(), name_ + ": filters");
  }
  filters_ = std::move(kept);
}

void Link::mute() noexcept {
  const std::lock_guard lock(mutex_);
  muted_ = true;
  filters_.clear();
  socketcan::mute(socket());
}

void Link::count_lost() {
  const std::lock_guard lock(mutex_);
  count_lost_locked();
}

void Link::count_lost_locked() {
  if (const auto drops = count_drops(socket())) {
    dropped_ += static_cast<std::uint32_t>(*drops - static_cast<std::uint32_t>(dropped_));
  }
  tell_news();
}

void Link::fill(Statistics& statistics) {
  const std::lock_guard lock(mutex_);
  count_lost_locked();
  statistics.dropped = dropped_;
  statistics.error_frames = error_frames_;
  statistics.bus_offs = bus_offs_;
  statistics.outages = outages_;
  statistics.overruns = overruns_;
}

}  // namespace roio::socketcan
