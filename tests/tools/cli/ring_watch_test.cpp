// RingWatch: what is a ring, and what only looks like one.
#include "attach/ring_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace roio::cli {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Clock = RingWatch::Clock;
using Time = std::chrono::microseconds;

Frame frame(std::uint32_t id) {
  Frame frame{};
  frame.id = id;
  frame.kind = FrameKind::extended;
  frame.length = 1;
  return frame;
}

/// A frame that comes from one side every so often.
struct Source {
  std::size_t side;
  std::uint32_t id;
  Time period;
  Time begins;
};

/// @return when it was told to be a storm; none within ten seconds.
std::optional<Time> storm_after(std::vector<Source> sources) {
  RingWatch watch;
  const Clock::time_point start = Clock::now();
  for (;;) {
    Source* next = &sources.front();
    for (Source& source : sources) {
      next = source.begins < next->begins ? &source : next;
    }
    if (next->begins > std::chrono::seconds(10)) {
      return std::nullopt;
    }
    const Frame one = frame(next->id);
    if (!watch.pass(next->side, {&one, 1}, start + next->begins)) {
      return next->begins;
    }
    next->begins += next->period;
  }
}

// In a ring each frame comes from both sides again and again: one copy goes round either way.
std::vector<Source> ring(std::uint32_t frames, Time round) {
  std::vector<Source> sources;
  for (std::uint32_t i = 0; i < frames; ++i) {
    const Time begins = round * i / frames;
    sources.push_back({0, i, round, begins});
    sources.push_back({1, i, round, begins + Time(1)});
  }
  return sources;
}

std::vector<Source> operator+(std::vector<Source> a, const std::vector<Source>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(RingWatch, WhatIsNone) {
  const std::vector<std::tuple<const char*, std::vector<Source>>> rows{
      {"a cyclic frame that comes back once from a loop",
       {{0, 1, milliseconds(10), Time(0)}, {1, 1, milliseconds(10), milliseconds(1)}}},
      {"two that say the same 50 times a second, at once",
       {{0, 1, milliseconds(20), Time(0)}, {1, 1, milliseconds(20), Time(0)}}},
      {"two that say the same 50 times a second, in turns",
       {{0, 1, milliseconds(20), Time(0)}, {1, 1, milliseconds(20), milliseconds(10)}}},
      {"two that say the same 140 times a second, in turns",
       {{0, 1, microseconds(7142), Time(0)}, {1, 1, microseconds(7142), microseconds(3571)}}},
      {"a full bus of few frames, all of one side",
       {{0, 1, microseconds(120), Time(0)}, {0, 2, microseconds(120), Time(60)}}},
      {"full buses of few frames, others on each side",
       {{0, 1, microseconds(60), Time(0)}, {1, 2, microseconds(60), Time(30)}}},
      {"two that say the same, ahead of others on a full bus",
       {{0, 1, milliseconds(1), Time(0)},
        {1, 1, milliseconds(1), Time(500)},
        {0, 2, microseconds(120), Time(60)}}},
  };
  for (const auto& [what, sources] : rows) {
    EXPECT_FALSE(storm_after(sources)) << what;
  }
}

TEST(RingWatch, WhatIsOneAndIsEndedInTime) {
  const std::vector<std::tuple<const char*, std::vector<Source>>> rows{
      {"one frame, as on local buses", ring(1, microseconds(100))},
      {"one frame, over bridges", ring(1, milliseconds(4))},
      {"as slow as it may be", ring(1, microseconds(6500))},
      {"a few frames", ring(10, milliseconds(2))},
      {"a flood of them, each of which waits for the others", ring(1000, milliseconds(50))},
      {"others say something meanwhile",
       ring(2, milliseconds(1)) + std::vector<Source>{{0, 99, milliseconds(10), Time(0)}}},
  };
  for (const auto& [what, sources] : rows) {
    const auto after = storm_after(sources);
    ASSERT_TRUE(after) << what;
    EXPECT_LE(*after, std::chrono::seconds(2)) << what;
  }
}

}  // namespace
}  // namespace roio::cli
