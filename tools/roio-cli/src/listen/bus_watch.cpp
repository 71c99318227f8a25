#include "listen/bus_watch.hpp"

#include <utility>

namespace roio::cli {
BusWatch::BusWatch(const Bus& bus, Tell tell)
    : bus_(bus), tell_(std::move(tell)), is_local_(bus.name().starts_with("local:")) {}

void BusWatch::look() {
  if (told_fd_frames_ == 0) {
    tell_fd_frames();
  }
  const BusState state = bus_.state();
  hub_watch_.look(state, HubWatch::Clock::now());
  if (is_local_ && hub_watch_.is_between_hubs()) {
    return;
  }
  const std::uint64_t outages = bus_.statistics().outages;
  const bool is_out = state == BusState::down || state == BusState::absent;
  // An outage that began and ended between two looks.
  if (outages != outages_ && !is_out && !is_local_) {
    announce(BusState::down);
  }
  announce(state);
  outages_ = outages;
}

void BusWatch::tell_fd_frames() {
  const std::uint64_t seen = bus_.statistics().fd_frames;
  if (seen > told_fd_frames_) {
    tell_({BusNews::Kind::not_shown, seen - told_fd_frames_, {}});
    told_fd_frames_ = seen;
  }
}

void BusWatch::announce(BusState state) {
  if (state != state_) {
    tell_({BusNews::Kind::state, 0, state});
    state_ = state;
  }
}

}  // namespace roio::cli
