#include "listen/intake.hpp"

#include <algorithm>

namespace roio::cli {
namespace {

constexpr std::size_t batch_size = 256;

// So long, once a frame is here, one of another bus that was earlier may still be on its way: from
// the kernel, or through the program that carries a local bus.
constexpr std::chrono::milliseconds others_have{2};

// A frame that has waited so long for others is next, whatever its time: a clock may have been set
// since.
constexpr std::chrono::milliseconds longest_wait{50};

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
  if (!earliest(Clock::now())) {
    if (!Interrupt::wait_readable(fds_, timeout)) {
      return Interrupt::signal() != 0 ? Result::cancelled : Result::timeout;
    }
    refill();
  }
  if (const auto first = earliest(Clock::now()); first && !is_behind()) {
    static_cast<void>(Interrupt::sleep_until(waiting_[*first].arrived + others_have));
  }
  refill();
  merge(most, !is_behind());
  return heard_.empty() ? Result::timeout : Result::ok;
}

void Intake::take(std::size_t most) {
  heard_.clear();
  refill();
  merge(most, false);
}

void Intake::refill() {
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    Waiting& waiting = waiting_[i];
    if (waiting.is_empty()) {
      waiting.next = 0;
      waiting.end = buses_[i]->receive(std::span(waiting.batch), no_wait).count;
      waiting.may_have_more = waiting.end == waiting.batch.size();
      waiting.arrived = Clock::now();
    }
  }
}

// Ends where another bus may still have what is earlier: where its batch is at its end, it is asked
// again first.
void Intake::merge(std::size_t most, bool hold_back) {
  const auto now = Clock::now();
  while (heard_.size() < most) {
    const auto from = earliest(now);
    if (!from || (hold_back && waiting_[*from].arrived + others_have > now)) {
      return;
    }
    Waiting& waiting = waiting_[*from];
    heard_.push_back({*from, &waiting.batch[waiting.next++]});
    if (waiting.is_empty()) {
      return;
    }
  }
}

// Who does not keep up has no time to wait.
bool Intake::is_behind() const {
  return std::any_of(waiting_.begin(), waiting_.end(), [](const Waiting& waiting) {
    return !waiting.is_empty() && waiting.may_have_more;
  });
}

std::optional<std::size_t> Intake::earliest(Clock::time_point now) const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (!waiting_[i].is_empty() && (!found || goes_before(waiting_[i], waiting_[*found], now))) {
      found = i;
    }
  }
  return found;
}

// Both have something.
bool Intake::goes_before(const Waiting& one, const Waiting& other, Clock::time_point now) {
  const bool one_is_late = now - one.arrived > longest_wait;
  const bool other_is_late = now - other.arrived > longest_wait;
  return one_is_late != other_is_late ? one_is_late
                                      : one.batch[one.next].time < other.batch[other.next].time;
}

}  // namespace roio::cli
