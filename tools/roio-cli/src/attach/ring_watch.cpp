#include "attach/ring_watch.hpp"

#include <algorithm>
#include <string_view>

#include "attach/rings.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t slot_count = 4096;

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

RingWatch::RingWatch() : sent_to_{Memory(slot_count), Memory(slot_count)} {}

bool RingWatch::pass(std::size_t from, std::span<const Frame> frames, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (now - second_begins_ > std::chrono::seconds(1)) {
    second_begins_ = now;
    frames_ = 0;
    gone_round_ = 0;
  }
  for (const Frame& frame : frames) {
    const std::uint64_t content = content_of(frame);
    const std::uint32_t rounds = rounds_of(sent_to_.at(from), content, now);
    remember(sent_to_.at(1 - from), content, rounds, now);
    ++frames_;
    gone_round_ += rounds >= storm_rounds ? 1 : 0;
  }
  // Nine of ten, so that what others say meanwhile hides nothing.
  return gone_round_ < storm_frames || gone_round_ * 10 < frames_ * 9;
}

std::uint32_t RingWatch::rounds_of(Memory& sent_to_it, std::uint64_t content,
                                   Clock::time_point now) {
  Slot& slot = sent_to_it[content % slot_count];
  if (slot.content != content || slot.count == 0 || now - slot.time > memory) {
    return 0;
  }
  --slot.count;
  return slot.rounds + 1;
}

void RingWatch::remember(Memory& sent_to_it, std::uint64_t content, std::uint32_t rounds,
                         Clock::time_point now) {
  Slot& slot = sent_to_it[content % slot_count];
  const bool is_same = slot.content == content && slot.count > 0 && now - slot.time <= memory;
  slot.rounds = is_same ? std::max(slot.rounds, rounds) : rounds;
  slot.count = is_same ? slot.count + 1 : 1;
  slot.content = content;
  slot.time = now;
}

}  // namespace roio::cli
