#include "local/outbox.hpp"

#include <algorithm>

namespace roio::local {

bool Outbox::offer(const Frame& frame, Buffer& out) {
  const std::size_t lane = in_order_ ? normal_lane : lane_of(frame);
  auto& kept = kept_.at(lane);
  if (kept.size() >= window_) {
    return false;
  }
  kept.push_back({sequence_.at(lane) + 1, static_cast<std::uint32_t>(lane), 0, to_wire(frame)});
  try {
    append_record(out, kept.back());
  } catch (...) {
    kept.pop_back();
    throw;
  }
  ++sequence_.at(lane);
  ++offered_.at(lane);
  return true;
}

std::size_t Outbox::offer_again(Buffer& out) {
  std::size_t count = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const auto& kept = kept_.at(lane);
    std::size_t& offered = offered_.at(lane);
    while (offered < kept.size() && offered < window_) {
      append_record(out, kept.at(offered));
      ++offered;
      ++count;
    }
  }
  return count;
}

void Outbox::settle(const Slot& slot) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    auto& kept = kept_.at(lane);
    const std::uint64_t done = slot.done.at(lane).load(std::memory_order_seq_cst);
    while (!kept.empty() && kept.front().sequence <= done) {
      kept.pop_front();
      ++settled_;
      offered_.at(lane) -= std::min<std::size_t>(offered_.at(lane), 1);
    }
  }
}

}  // namespace roio::local
