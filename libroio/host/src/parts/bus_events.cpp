#include <roio/parts/bus_events.hpp>
#include <utility>

namespace roio {

Events BusEvents::take() noexcept {
  const std::lock_guard lock(mutex_);
  if (pending_.any()) {
    told_.clear();
  }
  return std::exchange(pending_, {});
}

void BusEvents::tell(bool Events::*what) noexcept {
  const std::lock_guard lock(mutex_);
  if (!pending_.any()) {
    told_.set();
  }
  pending_.*what = true;
}

void BusEvents::look(BusState state, std::uint64_t lost) noexcept {
  if (std::exchange(state_, state) != state) {
    tell(&Events::state);
  }
  if (std::exchange(lost_, lost) != lost) {
    tell(&Events::loss);
  }
}

// The flag is set before room_expected_ is looked at, and below the other way around: one of the
// two sees the other.
void BusEvents::set_room() noexcept {
  room_.set();
  tell_room();
}

void BusEvents::expect_room() noexcept {
  room_expected_.store(true, std::memory_order_seq_cst);
  if (room_.is_set()) {
    tell_room();
  }
}

void BusEvents::tell_room() noexcept {
  if (room_expected_.load(std::memory_order_seq_cst) &&
      room_expected_.exchange(false, std::memory_order_seq_cst)) {
    tell(&Events::room);
  }
}

}  // namespace roio
