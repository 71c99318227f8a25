#include "local/readers.hpp"

#include <algorithm>

namespace roio::local {
namespace {

// Taken away at once from a reader that the log runs over, so that it can read meanwhile.
constexpr std::uint64_t lot = 1024;
// Moving by fewer than this in one patience (some 10,000 frames a second, less than a saturated
// 1 Mbit/s bus brings) does not count as reading: the others should not crawl along with it.
constexpr std::uint64_t reading = 1024;
// A reader moves on some thousand times a second at most; one whose position changes at each of so
// many looks is none that reads.
constexpr int most_tries = 64;

}  // namespace

void Readers::add(std::size_t slot) {
  states_.at(slot) = State{};
  used_.push_back(slot);
}

void Readers::remove(std::size_t slot) {
  std::erase(used_, slot);
}

std::size_t Readers::listeners() const {
  return static_cast<std::size_t>(
      std::count_if(used_.begin(), used_.end(),
                    [this](std::size_t slot) { return listens(memory_.slots.at(slot)); }));
}

void Readers::take_away(std::uint64_t number) {
  if (number < unread_) {
    return;
  }
  // Who begins to listen later begins behind the head.
  std::uint64_t first = head() + 1;
  for (const std::size_t slot : used_) {
    if (listens(memory_.slots.at(slot))) {
      first = std::min(first, take_away_from(slot, number));
    }
  }
  unread_ = first;
}

/// @return the number that the reader reads next.
std::uint64_t Readers::take_away_from(std::size_t index, std::uint64_t number) {
  Slot& slot = memory_.slots.at(index);
  SlotFilters& filters = states_.at(index).filters;
  std::uint64_t word = slot.position.load(std::memory_order_acquire);
  for (int tries = 1;; ++tries) {
    const Position at = unpack(word);
    if (at.next > number) {
      return at.next;
    }
    const std::uint64_t next = std::min(number + lot, head()) + 1;
    filters.look(slot);
    std::uint64_t wanted = 0;
    const std::uint64_t own = slot.client.load(std::memory_order_relaxed);
    for (std::uint64_t i = std::max(at.next, oldest()); i < next; ++i) {
      const Carried carried = load(entry_of(memory_, i));
      wanted += carried.sender != own && filters.want(carried.frame.tagged_id) ? 1U : 0U;
    }
    const std::uint64_t dropped =
        exact_dropped(at.dropped, slot.dropped.load(std::memory_order_relaxed)) + wanted;
    const std::uint64_t taken = pack({next, static_cast<std::uint16_t>(dropped)});
    if (tries == most_tries) {
      slot.position.store(taken, std::memory_order_release);
    }
    if (tries == most_tries ||
        slot.position.compare_exchange_strong(word, taken, std::memory_order_acq_rel)) {
      slot.dropped.store(dropped, std::memory_order_release);
      return next;
    }
  }
}

void Readers::wake_for_news() {
  for (const std::size_t slot : used_) {
    if (states_.at(slot).wake != nullptr &&
        memory_.slots.at(slot).sleeping.load(std::memory_order_seq_cst) != 0) {
      wake_if_wanted(slot);
    }
  }
}

void Readers::wake_if_wanted(std::size_t index) {
  Slot& slot = memory_.slots.at(index);
  SlotFilters& filters = states_.at(index).filters;
  filters.look(slot);
  std::uint64_t word = slot.position.load(std::memory_order_acquire);
  const Position at = unpack(word);
  const std::uint64_t last = head();
  const std::uint64_t own = slot.client.load(std::memory_order_relaxed);
  std::uint64_t next = std::max(at.next, oldest());
  for (bool wanted = false; next <= last && !wanted; next += wanted ? 0 : 1) {
    const Carried carried = load(entry_of(memory_, next));
    wanted = carried.sender != own && filters.want(carried.frame.tagged_id);
  }
  // Failing, it reads by itself just now.
  if (next != at.next) {
    slot.position.compare_exchange_strong(word, pack({next, at.dropped}),
                                          std::memory_order_acq_rel);
  }
  if (next <= last) {
    wake(index);
  }
}

void Readers::wake(std::size_t slot) {
  if (EventFlag* const flag = states_.at(slot).wake) {
    memory_.slots.at(slot).sleeping.store(0, std::memory_order_relaxed);
    flag->set();
  }
}

void Readers::wake_for_done(std::size_t slot) {
  if (memory_.slots.at(slot).awaits_done.exchange(0, std::memory_order_seq_cst) != 0) {
    wake(slot);
  }
}

bool Readers::hold_bus(TimePoint now) {
  bool hold = false;
  for (const std::size_t slot : used_) {
    if (listens(memory_.slots.at(slot)) && lags(slot, now)) {
      memory_.slots.at(slot).bus_waits.store(1, std::memory_order_seq_cst);
      hold = true;
    }
  }
  return hold;
}

bool Readers::lags(std::size_t index, TimePoint now) {
  const Slot& slot = memory_.slots.at(index);
  State& state = states_.at(index);
  const std::uint64_t next = unpack(slot.position.load(std::memory_order_relaxed)).next;
  const bool program = state.program.wait_for(slot.queued.load(std::memory_order_relaxed) > max_lag,
                                              slot.consumed.load(std::memory_order_relaxed), now);
  const bool library = state.library.wait_for(next + max_lag <= head(), next, now);
  return program || library;
}

bool Readers::Progress::wait_for(bool lags, std::uint64_t now_value, TimePoint now) {
  // It starts to lag: its patience starts here. Afterwards only moving renews it.
  if ((lags && !lagging) || now_value - value >= reading) {
    value = now_value;
    since = now;
  }
  lagging = lags;
  return lags && now - since < patience;
}

}  // namespace roio::local
