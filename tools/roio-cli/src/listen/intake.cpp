#include "listen/intake.hpp"

#include <algorithm>

namespace roio::cli {
namespace {

constexpr std::size_t batch_size = 256;

}  // namespace

Intake::Intake(std::span<const std::unique_ptr<Bus>> buses) : buses_(buses) {
  for (const auto& bus : buses) {
    waiting_.push_back({std::vector<Received>(batch_size)});
    fds_.push_back(bus->fd());
  }
  if (buses.size() == 1) {
    cancel_on_signal_.emplace(*buses.front());
  }
}

Result Intake::receive(std::size_t most, Timeout timeout) {
  heard_.clear();
  return buses_.size() == 1 ? receive_from_one(most, timeout) : receive_from_several(most, timeout);
}

Result Intake::receive_from_one(std::size_t most, Timeout timeout) {
  std::vector<Received>& batch = waiting_.front().batch;
  const auto room = std::span(batch).first(std::min(most, batch.size()));
  const Transfer transfer = buses_.front()->receive(room, timeout);
  for (const Received& received : room.first(transfer.count)) {
    heard_.push_back({0, &received});
  }
  return transfer.result;
}

Result Intake::receive_from_several(std::size_t most, Timeout timeout) {
  if (!earliest() && !Interrupt::wait_readable(fds_, timeout)) {
    return Interrupt::signal() != 0 ? Result::cancelled : Result::timeout;
  }
  refill();
  merge(most);
  return heard_.empty() ? Result::timeout : Result::ok;
}

void Intake::refill() {
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    Waiting& waiting = waiting_[i];
    if (waiting.is_empty()) {
      waiting.next = 0;
      waiting.end = buses_[i]->receive(std::span(waiting.batch), no_wait).count;
      waiting.may_have_more = waiting.end == waiting.batch.size();
    }
  }
}

// Ends where a bus has been emptied that may have earlier frames than the others.
void Intake::merge(std::size_t most) {
  while (heard_.size() < most) {
    const auto from = earliest();
    if (!from) {
      return;
    }
    Waiting& waiting = waiting_[*from];
    heard_.push_back({*from, &waiting.batch[waiting.next++]});
    if (waiting.is_empty() && waiting.may_have_more) {
      return;
    }
  }
}

std::optional<std::size_t> Intake::earliest() const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const Waiting& waiting = waiting_[i];
    if (waiting.is_empty()) {
      continue;
    }
    if (!found ||
        waiting.batch[waiting.next].time < waiting_[*found].batch[waiting_[*found].next].time) {
      found = i;
    }
  }
  return found;
}

}  // namespace roio::cli
