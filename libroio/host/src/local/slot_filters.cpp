#include "local/slot_filters.hpp"

#include <algorithm>

namespace roio::local {
namespace {

constexpr unsigned mask_shift = 32;

}  // namespace

void publish_filters(Slot& slot, std::span<const SocketCanFilter> filters) noexcept {
  const std::uint32_t version = slot.filter_version.load(std::memory_order_relaxed) | 1U;
  slot.filter_version.store(version, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  for (std::size_t i = 0; i < filters.size(); ++i) {
    slot.filters.at(i).store(std::uint64_t{filters[i].can_mask} << mask_shift | filters[i].can_id,
                             std::memory_order_relaxed);
  }
  slot.filter_count.store(static_cast<std::uint32_t>(filters.size()), std::memory_order_seq_cst);
  slot.filter_version.store(version + 1, std::memory_order_seq_cst);
}

void SlotFilters::look(const Slot& slot) {
  const std::uint32_t version = slot.filter_version.load(std::memory_order_acquire);
  if (version == version_) {
    return;
  }
  const std::size_t count =
      std::min<std::size_t>(slot.filter_count.load(std::memory_order_relaxed), max_filters);
  filters_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t word = slot.filters.at(i).load(std::memory_order_relaxed);
    filters_.push_back(
        {static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(word >> mask_shift)});
  }
  std::atomic_thread_fence(std::memory_order_acquire);
  changing_ = version % 2 != 0 || slot.filter_version.load(std::memory_order_relaxed) != version;
  version_ = changing_ ? never_looked : version;
}

}  // namespace roio::local
