#include "local/log_reader.hpp"

#include <algorithm>

namespace roio::local {

LogReader::Read LogReader::read(std::span<Carried> frames) noexcept {
  for (;;) {
    std::uint64_t word = slot_.position.load(std::memory_order_acquire);
    const Position at = unpack(word);
    // Between the two looks at the position: so it is of about the same moment.
    const std::uint64_t dropped =
        exact_dropped(at.dropped, slot_.dropped.load(std::memory_order_relaxed));
    const std::uint64_t last = head();
    if (at.next > last) {
      return {0, 0};  // what has been taken away is told with the next one
    }
    const std::size_t count = std::min<std::uint64_t>(frames.size(), last - at.next + 1);
    for (std::size_t i = 0; i < count; ++i) {
      frames[i] = load(entry_of(memory_, at.next + i));
    }
    if (slot_.position.compare_exchange_strong(word, pack({at.next + count, at.dropped}),
                                               std::memory_order_acq_rel)) {
      const std::uint64_t lost = dropped - told_;
      told_ = dropped;
      return {count, lost};
    }
  }
}

void LogReader::begin() noexcept {
  std::uint64_t word = slot_.position.load(std::memory_order_acquire);
  while (!slot_.position.compare_exchange_weak(word, pack({head() + 1, unpack(word).dropped}),
                                               std::memory_order_acq_rel)) {
  }
  const std::uint64_t dropped = all_dropped();
  never_due_ += dropped - told_;
  told_ = dropped;
}

bool LogReader::sleep() noexcept {
  // The hub writes the head and then looks at this; one of the two sees the other.
  slot_.sleeping.store(1, std::memory_order_seq_cst);
  if (unpack(slot_.position.load(std::memory_order_acquire)).next > head()) {
    return true;
  }
  stay_awake();
  return false;
}

std::uint64_t LogReader::all_dropped() const noexcept {
  for (;;) {
    const std::uint64_t word = slot_.position.load(std::memory_order_acquire);
    const std::uint64_t near = slot_.dropped.load(std::memory_order_acquire);
    if (slot_.position.load(std::memory_order_acquire) == word) {
      return exact_dropped(unpack(word).dropped, near);
    }
  }
}

}  // namespace roio::local
