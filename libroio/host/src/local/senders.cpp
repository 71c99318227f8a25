#include "local/senders.hpp"

#include <algorithm>

namespace roio::local {

bool Senders::is_new(std::uint64_t sender, std::size_t lane, std::uint64_t sequence) {
  auto found = senders_.find(sender);
  if (found == senders_.end()) {
    if (senders_.size() >= max_senders) {
      forget_one();
    }
    found = senders_.emplace(sender, Entry{}).first;
  }
  Entry& entry = found->second;
  entry.heard = ++heard_;
  if (sequence <= entry.last.at(lane)) {
    return false;
  }
  entry.last.at(lane) = sequence;
  return true;
}

void Senders::forget_one() {
  senders_.erase(std::min_element(
      senders_.begin(), senders_.end(),
      [](const auto& a, const auto& b) { return a.second.heard < b.second.heard; }));
}

}  // namespace roio::local
