#include "pace.hpp"

#include <gtest/gtest.h>

namespace roio::sim_tool {
namespace {

using namespace std::chrono_literals;
const Pace::Clock::time_point start{1000s};

TEST(Pace, FollowsTheClockAtItsSpeed) {
  Pace half(0.5, start);
  EXPECT_EQ(half.due(start, 0ms), 0ms);
  EXPECT_EQ(half.due(start + 40ms, 0ms), 20ms);
  EXPECT_EQ(half.behind(), 0ms);
  Pace tenfold(10, start);
  EXPECT_EQ(tenfold.due(start + 40ms, 399ms), 400ms);
}

TEST(Pace, WithoutASpeedThereIsAlwaysMoreToDo) {
  Pace pace(0, start);
  EXPECT_EQ(pace.due(start + 10s, 5ms), 6ms);
  EXPECT_EQ(pace.behind(), 0ms);
}

TEST(Pace, CatchesUpOnAMomentAndGivesUpTheRest) {
  Pace pace(1, start);
  EXPECT_EQ(pace.due(start + 100ms, 0ms), 100ms);
  EXPECT_EQ(pace.behind(), 0ms) << "as late as it may be";
  EXPECT_EQ(pace.due(start + 350ms, 0ms), 100ms);
  EXPECT_EQ(pace.behind(), 250ms);
  // From there on it goes with the clock.
  EXPECT_EQ(pace.due(start + 360ms, 100ms), 110ms);
  EXPECT_EQ(pace.behind(), 250ms);
}

TEST(Pace, LateIsMeantInRealTime) {
  Pace tenfold(10, start);
  EXPECT_EQ(tenfold.due(start + 90ms, 0ms), 900ms);
  EXPECT_EQ(tenfold.behind(), 0ms);
  EXPECT_EQ(tenfold.due(start + 150ms, 0ms), 1000ms);
  EXPECT_EQ(tenfold.behind(), 50ms);
}

}  // namespace
}  // namespace roio::sim_tool
