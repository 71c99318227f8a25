#include "network_exchange.hpp"

#include <algorithm>
#include <roio/header.hpp>
#include <utility>

namespace roio::sim {
namespace {

constexpr std::size_t urgent_lane = 0;
constexpr std::size_t normal_lane = 1;

std::size_t lane_of(const Frame& frame) {
  return is_extended(frame.kind) && unpack_id(frame.id).priority == Priority::urgent ? urgent_lane
                                                                                     : normal_lane;
}

}  // namespace

Exchange::Exchange(const OpenOptions& options) : error_frames_(options.error_frames) {
  if (!options.send_only) {
    filters_ = {SocketCanFilter{0, 0}};
  }
}

// --- the program's side --------------------------------------------------------------------------

Exchange::Offered Exchange::offer(std::span<const Frame> frames, SimTime since) {
  const std::lock_guard lock(mutex_);
  Offered offered{0, lanes_[urgent_lane].empty() && lanes_[normal_lane].empty()};
  const bool open = !closed_ && state_ != BusState::absent;
  while (open && offered.count < frames.size()) {
    const Frame& frame = frames[offered.count];
    auto& lane = lanes_.at(lane_of(frame));
    if (lane.size() >= lane_capacity) {
      break;
    }
    lane.push_back({frame, since});
    ++offered.count;
  }
  statistics_.sent += offered.count;
  offered.wake = offered.wake && offered.count > 0;
  sender_waits_ = offered.count < frames.size();
  if (sender_waits_) {
    sendable_.clear();
  }
  return offered;
}

void Exchange::count_send_wait() {
  const std::lock_guard lock(mutex_);
  ++statistics_.send_waits;
}

void Exchange::count_send_timeout() {
  const std::lock_guard lock(mutex_);
  ++statistics_.send_timeouts;
}

std::size_t Exchange::take(std::span<Received> frames) {
  const std::lock_guard lock(mutex_);
  const std::size_t count = std::min(frames.size(), queue_.size());
  const auto end = queue_.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(queue_.begin(), end, frames.begin());
  statistics_.received +=
      static_cast<std::uint64_t>(std::count_if(queue_.begin(), end, [](const Received& received) {
        return received.frame.kind != FrameKind::error;
      }));
  queue_.erase(queue_.begin(), end);
  if (queue_.empty()) {
    readable_.clear();
  }
  return count;
}

void Exchange::set_filters(std::span<const SocketCanFilter> filters) {
  const std::lock_guard lock(mutex_);
  filters_.assign(filters.begin(), filters.end());
}

BusState Exchange::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

Statistics Exchange::statistics() const {
  const std::lock_guard lock(mutex_);
  return statistics_;
}

void Exchange::close(std::chrono::nanoseconds patience) {
  std::unique_lock lock(mutex_);
  closed_ = true;
  settled_.wait_for(lock, patience, [this] { return all_settled(); });
}

// --- the simulation's side -----------------------------------------------------------------------

bool Exchange::all_settled() const {
  return in_chip_ == 0 && lanes_[urgent_lane].empty() && lanes_[normal_lane].empty();
}

bool Exchange::has_work() const {
  const std::lock_guard lock(mutex_);
  return !all_settled();
}

std::optional<Frame> Exchange::next(std::size_t lane, SimTime now) const {
  const std::lock_guard lock(mutex_);
  const auto& waiting = lanes_.at(lane);
  return waiting.empty() || waiting.front().since > now ? std::nullopt
                                                        : std::optional(waiting.front().frame);
}

void Exchange::handed_over(std::size_t lane) {
  const std::lock_guard lock(mutex_);
  lanes_.at(lane).pop_front();
  ++in_chip_;
  if (std::exchange(sender_waits_, false)) {
    sendable_.set();
  }
}

void Exchange::settled(bool sent) {
  const std::lock_guard lock(mutex_);
  --in_chip_;
  statistics_.unsent += sent ? 0 : 1;
  if (all_settled()) {
    settled_.notify_all();
  }
}

void Exchange::deliver(const Frame& frame, Timestamp time) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t tagged = tagged_id(frame);
  if (std::any_of(filters_.begin(), filters_.end(),
                  [tagged](const SocketCanFilter& filter) { return accepts(filter, tagged); })) {
    enqueue(frame, time);
  }
}

void Exchange::enqueue(const Frame& frame, Timestamp time) {
  if (closed_) {
    return;
  }
  if (queue_.size() >= receive_capacity) {
    ++statistics_.dropped;
    ++lost_;
    return;
  }
  queue_.push_back({frame, time, std::exchange(lost_, 0)});
  if (queue_.size() == 1) {
    readable_.set();
  }
}

void Exchange::tell(const News& news, Timestamp time) {
  const std::lock_guard lock(mutex_);
  state_ = news.state;
  statistics_.overruns += news.overruns;
  statistics_.bus_offs += news.bus_offs;
  ++statistics_.error_frames;
  if (error_frames_) {
    enqueue(news.report, time);
  }
}

void Exchange::count_outage() {
  const std::lock_guard lock(mutex_);
  ++statistics_.outages;
}

void Exchange::abandon() {
  const std::lock_guard lock(mutex_);
  abandon_locked();
}

void Exchange::abandon_locked() {
  for (auto& lane : lanes_) {
    statistics_.unsent += lane.size();
    lane.clear();
  }
}

void Exchange::end() {
  const std::lock_guard lock(mutex_);
  abandon_locked();
  statistics_.unsent += std::exchange(in_chip_, 0);
  state_ = BusState::absent;
  ++statistics_.outages;
  settled_.notify_all();
}

}  // namespace roio::sim
