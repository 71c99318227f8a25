#include "local/outbox.hpp"

#include <algorithm>

namespace roio::local {

bool Outbox::offer(const Frame& frame, Buffer& out) {
  offer_again(out);  // those before it first: the hub takes a frame for the sign of all before it
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
  std::array<std::uint64_t, lane_count> done{};
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    done.at(lane) = slot.done.at(lane).load(std::memory_order_seq_cst);
  }
  settle(done);
}

void Outbox::settle(const std::array<std::uint64_t, lane_count>& done) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    auto& kept = kept_.at(lane);
    while (!kept.empty() && kept.front().sequence <= done.at(lane)) {
      kept.pop_front();
      offered_.at(lane) -= std::min<std::size_t>(offered_.at(lane), 1);
      ++settled_;
    }
  }
}

}  // namespace roio::local
