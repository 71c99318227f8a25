#include "attach/ring_watch.hpp"

#include <algorithm>
#include <string_view>

#include "attach/rings.hpp"

namespace roio::cli {
namespace {

std::uint64_t content_of(const Frame& frame) {
  std::array<char, 5 + max_data_length> bytes{};
  const std::uint32_t id = tagged_id(frame);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[i] = static_cast<char>(id >> (8 * i));
  }
  bytes[4] = static_cast<char>(frame.length);
  const std::size_t length = is_remote(frame.kind) ? 0 : frame.length;
  std::copy_n(frame.data, length, bytes.begin() + 5);
  return number_of(std::string_view(bytes.data(), 5 + length));
}

}  // namespace

RoundCount::RoundCount(Clock::duration turnaround, std::uint64_t storm_frames, std::size_t contents)
    : turnaround_(turnaround),
      storm_frames_(storm_frames),
      sent_to_{Memory(contents), Memory(contents)} {}

void RoundCount::pass(std::size_t from, std::uint64_t content, Clock::time_point now) {
  if (now - second_begins_ > std::chrono::seconds(1)) {
    second_begins_ = now;
    frames_ = 0;
    gone_round_ = 0;
  }
  const std::uint32_t rounds = rounds_of(sent_to_.at(from), content, now);
  remember(sent_to_.at(1 - from), content, rounds, now);
  ++frames_;
  gone_round_ += rounds >= storm_rounds ? 1 : 0;
}

// Nine of ten, so that what others say meanwhile hides nothing.
bool RoundCount::is_storm() const {
  return gone_round_ >= storm_frames_ && gone_round_ * 10 >= frames_ * 9;
}

std::uint32_t RoundCount::rounds_of(Memory& sent_to_it, std::uint64_t content,
                                    Clock::time_point now) const {
  Slot& slot = sent_to_it[content % sent_to_it.size()];
  if (slot.content != content || slot.count == 0 || now - slot.time > turnaround_) {
    return 0;
  }
  --slot.count;
  return slot.rounds + 1;
}

void RoundCount::remember(Memory& sent_to_it, std::uint64_t content, std::uint32_t rounds,
                          Clock::time_point now) const {
  Slot& slot = sent_to_it[content % sent_to_it.size()];
  const bool is_same = slot.content == content && slot.count > 0 && now - slot.time <= turnaround_;
  slot.rounds = is_same ? std::max(slot.rounds, rounds) : rounds;
  slot.count = is_same ? slot.count + 1 : 1;
  slot.content = content;
  slot.time = now;
}

bool RingWatch::pass(std::size_t from, std::span<const Frame> frames, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  for (const Frame& frame : frames) {
    const std::uint64_t content = content_of(frame);
    quick_.pass(from, content, now);
    flood_.pass(from, content, now);
  }
  return !quick_.is_storm() && !flood_.is_storm();
}

}  // namespace roio::cli
