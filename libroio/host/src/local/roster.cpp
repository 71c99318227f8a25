#include "local/roster.hpp"

#include <algorithm>
#include <unordered_map>

#include "local/log.hpp"
#include "local/presence.hpp"

namespace roio::local {

bool Roster::take_over() {
  for (std::size_t slot = 0; slot < max_clients; ++slot) {
    if (memory_.slots.at(slot).client.load(std::memory_order_relaxed) != 0) {
      readers_.add(slot);
    }
  }
  free_dead({});
  if (!has_anybody()) {
    return false;
  }
  note_done_from_log();
  return true;
}

// The last hub may have died after it had carried a frame and before it had told the sender. Or
// while it was writing the next one, in the place of the oldest that is kept: that one is left out.
void Roster::note_done_from_log() {
  std::unordered_map<std::uint64_t, Slot*> slots;
  for (Slot& slot : memory_.slots) {
    slots.emplace(slot.client.load(std::memory_order_relaxed), &slot);
  }
  for_each_whole(memory_, [&slots](const Carried& carried) {
    if (const auto sender = slots.find(carried.sender); sender != slots.end()) {
      auto& done = sender->second->done.at(carried.lane);
      done.store(std::max(done.load(std::memory_order_relaxed), carried.sequence),
                 std::memory_order_relaxed);
    }
  });
}

void Roster::free_dead(const Connected& connected) {
  for (std::size_t i = 0; i < max_clients; ++i) {
    Slot& slot = memory_.slots.at(i);
    const std::uint64_t client = slot.client.load(std::memory_order_relaxed);
    if (client != 0 && !connected.at(i) && !is_present(lock_fd_, client)) {
      slot.filter_count.store(0, std::memory_order_relaxed);
      slot.client.store(0, std::memory_order_relaxed);
      readers_.remove(i);
    }
  }
}

std::optional<std::size_t> Roster::slot_of(std::uint64_t client) const {
  const auto found = std::find_if(
      memory_.slots.begin(), memory_.slots.end(),
      [client](const Slot& slot) { return slot.client.load(std::memory_order_relaxed) == client; });
  return found == memory_.slots.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - memory_.slots.begin()));
}

std::optional<std::size_t> Roster::take_free(std::uint64_t client) {
  const auto index = slot_of(0);
  if (index) {
    Slot& slot = memory_.slots.at(*index);
    for (auto& done : slot.done) {
      done.store(0, std::memory_order_relaxed);
    }
    slot.unheard.store(0, std::memory_order_relaxed);
    slot.dropped.store(0, std::memory_order_relaxed);
    slot.position.store(pack({memory_.header.head.load(std::memory_order_relaxed) + 1, 0}),
                        std::memory_order_relaxed);
    slot.sleeping.store(0, std::memory_order_relaxed);
    slot.awaits_done.store(0, std::memory_order_relaxed);
    slot.bus_waits.store(0, std::memory_order_relaxed);
    slot.queued.store(0, std::memory_order_relaxed);
    slot.consumed.store(0, std::memory_order_relaxed);
    slot.filter_version.store(0, std::memory_order_relaxed);
    slot.filter_count.store(0, std::memory_order_relaxed);
    slot.client.store(client, std::memory_order_release);
    readers_.add(*index);
  }
  return index;
}

bool Roster::has_host_but(std::uint64_t client) const {
  const std::uint64_t host = living_host(memory_, lock_fd_);
  return host != 0 && host != client;
}

}  // namespace roio::local
