#include "serial/down.hpp"

#include <algorithm>

namespace roio::serial {
namespace {

constexpr std::size_t around = 1 + frame_head_down + check_length + 1;
constexpr std::size_t max_record_of_frame = around + max_data_length;

std::size_t bytes_on_line(const Frame& frame) {
  return around + (is_remote(frame.kind) ? 1U : frame.length);
}

Outcome outcome_of(std::uint32_t slots, std::size_t slot) {
  return static_cast<Outcome>((slots >> (2 * slot)) & 3U);
}

}  // namespace

std::size_t DownFrames::offer(std::span<const Frame> frames, Time end) {
  std::size_t count = 0;
  for (const Frame& frame : frames) {
    const std::size_t lane = lane_in_driver(frame);
    if (lanes_.at(lane).size() >= lane_capacity || !order_.admits(lane, done())) {
      break;
    }
    order_.accepted(lane);
    lanes_.at(lane).push_back({frame, end});
    ++count;
  }
  return count;
}

void DownFrames::begin() {
  for (Slot& slot : slots_) {
    if (slot.pending) {
      settle(slot, Outcome::unknown);
    }
  }
  taken_ = cursor_ = assigned_ = 0;
}

void DownFrames::drop_waiting() {
  for (auto& lane : lanes_) {
    counters_.dropped += lane.size();
    lane.clear();
  }
}

void DownFrames::drop_expired(Time now) {
  for (auto& lane : lanes_) {
    for (; !lane.empty() && now >= lane.front().end; lane.pop_front()) {
      ++counters_.dropped;
    }
  }
}

Time DownFrames::next_end() const {
  Time end = Time::max();
  for (const auto& lane : lanes_) {
    end = lane.empty() ? end : std::min(end, lane.front().end);
  }
  return end;
}

DownFrames::Lane* DownFrames::waiting_lane() {
  const auto lane =
      std::find_if(lanes_.begin(), lanes_.end(), [](const auto& one) { return !one.empty(); });
  return lane == lanes_.end() ? nullptr : &*lane;
}

std::size_t DownFrames::untaken() const {
  std::size_t bytes = 0;
  for (std::uint64_t i = taken_; i < cursor_; ++i) {
    bytes += bytes_on_line(slots_.at(slot_of(i)).frame);
  }
  return bytes;
}

std::optional<DownFrames::Numbered> DownFrames::next() {
  if (untaken() + max_record_of_frame > max_untaken) {
    return std::nullopt;
  }
  Slot& slot = slots_.at(slot_of(cursor_));
  if (cursor_ < assigned_) {
    ++counters_.resent;
  } else {
    Lane* const lane = waiting_lane();
    if (slot.pending || lane == nullptr) {
      return std::nullopt;
    }
    slot = {lane->front().frame, lane->front().end, true};
    lane->pop_front();
    ++pending_;
    ++assigned_;
  }
  return Numbered{slot.frame, static_cast<std::uint8_t>(cursor_++), slot.end};
}

DownFrames::Progress DownFrames::results(std::uint8_t next, std::uint32_t slots) {
  const auto more = static_cast<std::uint8_t>(next - static_cast<std::uint8_t>(taken_));
  if (taken_ + more > assigned_) {
    return Progress::nonsense;
  }
  Progress progress = more > 0 ? Progress::some : Progress::none;
  taken_ += more;
  cursor_ = std::max(cursor_, taken_);
  // The last 16 numbers have the slots; what is said of one is of the frame before it until the
  // bridge has taken it.
  for (std::uint64_t i = assigned_ - std::min<std::uint64_t>(assigned_, window); i < taken_; ++i) {
    if (settle(slots_.at(slot_of(i)), outcome_of(slots, slot_of(i)))) {
      progress = Progress::some;
    }
  }
  return progress;
}

/// @return whether that is news.
bool DownFrames::settle(Slot& slot, Outcome outcome) {
  if (!slot.pending || outcome == Outcome::pending) {
    return false;
  }
  slot.pending = false;
  --pending_;
  switch (outcome) {
    case Outcome::sent:
      ++counters_.sent;
      break;
    case Outcome::not_sent:
      ++counters_.not_sent;
      break;
    default:
      ++counters_.unknown;
      break;
  }
  return true;
}

}  // namespace roio::serial
