#include "bridge.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "program/exit_status.hpp"

namespace roio::sim_tool {
namespace {

// More than the shortest frames at 1 Mbit/s that go in a millisecond, which is how often it is
// filled up.
constexpr std::size_t most_in_node = 32;
constexpr std::size_t most_waiting = 256;
constexpr Bridge::Clock::duration longest_block = std::chrono::seconds(5);
// A process that was stopped for a while comes back to a bus that is not to blame.
constexpr Bridge::Clock::duration longest_between = std::chrono::milliseconds(100);

}  // namespace

Bridge::Bridge(sim::CanBus& bus, std::uint32_t bitrate_bps, std::unique_ptr<Bus> outside)
    : node_(bus, bitrate_bps), outside_(std::move(outside)), batch_(most_in_node) {
  if (outside_) {
    node_.on_receive([this](const Frame& frame) {
      waiting_.push_back(frame);
      // A DLC of 9..15 means 8 bytes, which is as much as the other bus can say.
      waiting_.back().length = std::min(frame.length, max_data_length);
    });
  }
}

std::size_t Bridge::room() const {
  return node_.waiting() < most_in_node ? most_in_node - node_.waiting() : 0;
}

void Bridge::set_alone(bool alone) {
  node_.controller().set_mode(alone ? sim::Controller::Mode::off : sim::Controller::Mode::normal);
}

bool Bridge::is_blocked() const {
  return waiting_.size() >= most_waiting;
}

int Bridge::fd() const {
  return outside_ && room() > 0 ? outside_->fd() : -1;
}

void Bridge::take() {
  if (!outside_ || room() == 0) {
    return;
  }
  const Transfer transfer = outside_->receive(std::span(batch_).first(room()), no_wait);
  for (const Received& received : std::span(batch_).first(transfer.count)) {
    node_.send(received.frame);
  }
  taken_ += transfer.count;
}

void Bridge::give(Clock::time_point now) {
  const Clock::duration passed = now - std::exchange(tried_, now).value_or(now);
  if (!outside_ || waiting_.empty()) {
    return;
  }
  const std::size_t count = outside_->send(std::span<const Frame>(waiting_), no_wait).count;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
  given_ += count;
  stuck_ = count > 0 ? Clock::duration(0) : stuck_ + std::min(passed, longest_between);
  if (stuck_ > longest_block) {
    throw cli::Failure(outside_->name() + ": has taken no frame for too long");
  }
}

std::uint64_t Bridge::lost() const {
  const std::uint64_t dropped = outside_ ? outside_->statistics().dropped : 0;
  return dropped + waiting_.size() + node_.waiting();
}

}  // namespace roio::sim_tool
