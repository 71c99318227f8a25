#include "network/exchange.hpp"

#include <algorithm>
#include <utility>

namespace roio::sim {
Exchange::Exchange(const OpenOptions& options)
    : error_frames_(options.error_frames), order_(options.in_order) {
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
    const std::size_t lane = lane_in_driver(frame);
    if (lanes_.at(lane).size() >= lane_capacity || !order_.admits(lane, all_settled())) {
      break;
    }
    order_.accepted(lane);
    lanes_.at(lane).push_back({frame, since});
    ++offered.count;
  }
  statistics_.sent += offered.count;
  offered.wake = offered.wake && offered.count > 0;
  sender_waits_ = offered.count < frames.size();
  if (sender_waits_) {
    events_.clear_room();
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
  return queue_.take(frames);
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
  Statistics statistics = statistics_;
  queue_.add_to(statistics);
  return statistics;
}

void Exchange::begin_close(const Deadline& until) {
  const std::lock_guard lock(mutex_);
  if (closed_) {
    return;
  }
  closed_ = until;
  if (left_) {
    left_locked();
  }
}

void Exchange::await_left() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return left_; });
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
  wake_sender();
}

void Exchange::settled(bool sent) {
  const std::lock_guard lock(mutex_);
  --in_chip_;
  statistics_.unsent += sent ? 0 : 1;
  if (all_settled()) {
    wake_sender();
  }
  look_for_events();
}

void Exchange::wake_sender() {
  if (std::exchange(sender_waits_, false)) {
    events_.set_room();
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
  if (!closed_) {
    queue_.put(frame, time);
    look_for_events();
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
  look_for_events();
}

void Exchange::look_for_events() {
  Statistics statistics = statistics_;
  queue_.add_to(statistics);
  events_.look(state_, statistics.dropped + statistics.unsent + statistics.overruns);
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
  wake_sender();
  look_for_events();
}

bool Exchange::wants_to_leave() const {
  const std::lock_guard lock(mutex_);
  return closed_ && (all_settled() || closed_->passed());
}

void Exchange::left() {
  const std::lock_guard lock(mutex_);
  left_locked();
}

void Exchange::left_locked() {
  left_ = true;
  if (closed_) {
    events_.tell(&Events::closed);
  }
  changed_.notify_all();
}

void Exchange::end() {
  const std::lock_guard lock(mutex_);
  abandon_locked();
  statistics_.unsent += std::exchange(in_chip_, 0);
  state_ = BusState::absent;
  ++statistics_.outages;
  look_for_events();
  left_locked();
}

}  // namespace roio::sim
