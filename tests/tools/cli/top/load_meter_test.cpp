// LoadMeter: rates, load and peak from when frames were on the bus.
#include "top/load_meter.hpp"

#include <gtest/gtest.h>

namespace roio::cli {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

// In the middle of a bin, as a program may start.
constexpr Timestamp start{seconds(1'700'000'000) + milliseconds(37)};

/// Frames one after the other, each `bits` long, at a share of the bit rate.
class LoadMeterTest : public testing::Test {
 protected:
  void run(Timeout time, std::uint32_t bitrate_bps, unsigned bits, double share) {
    const auto each = std::chrono::duration_cast<Timeout>(
        std::chrono::duration<double>(bits / share / bitrate_bps));
    const Timestamp end = now_ + time;
    for (; now_ + each <= end; now_ += each) {
      meter_.add(now_, bits);
    }
    now_ = end;
    meter_.advance(now_);
  }

  Timestamp now_ = start;
  LoadMeter meter_;
};

TEST_F(LoadMeterTest, ABusThatIsNeverIdleIsExactlyFull) {
  for (const std::uint32_t bitrate_bps : {1'000'000U, 125'000U, 10'000U}) {
    meter_ = {};
    meter_.set_bitrate(bitrate_bps);
    run(seconds(3), bitrate_bps, 131, 1.0);
    EXPECT_NEAR(*meter_.load().share, 1.0, 0.0005) << bitrate_bps;
    EXPECT_NEAR(*meter_.load().peak_share, 1.0, 0.0005) << bitrate_bps;
    EXPECT_NEAR(meter_.load().bits_per_s, bitrate_bps, bitrate_bps * 0.0005) << bitrate_bps;
  }
}

TEST_F(LoadMeterTest, LoadIsThatOfTheLastSecondAndThePeakThatOfTheBusiest) {
  meter_.set_bitrate(500'000);
  run(seconds(3), 500'000, 100, 0.8);
  run(seconds(3), 500'000, 100, 0.2);
  EXPECT_NEAR(*meter_.load().share, 0.2, 0.001);
  EXPECT_NEAR(*meter_.load().peak_share, 0.8, 0.001);
  EXPECT_NEAR(meter_.load().frames_per_s, 1000, 10);
  run(seconds(3), 500'000, 100, 0.0001);
  EXPECT_NEAR(*meter_.load().share, 0, 0.001);
}

TEST_F(LoadMeterTest, WithoutABitRateThereAreBitsASecondAlone) {
  run(seconds(3), 500'000, 100, 0.5);
  EXPECT_FALSE(meter_.load().share);
  EXPECT_FALSE(meter_.load().peak_share);
  EXPECT_NEAR(meter_.load().bits_per_s, 250'000, 250);
}

TEST_F(LoadMeterTest, HowLateFramesAreReadMakesNoDifference) {
  meter_.set_bitrate(1'000'000);
  // Read 150 ms after they were on the bus, while the time goes on in between.
  for (int i = 0; i < 30'000; ++i) {
    const Timestamp time = start + microseconds(100 * i);
    meter_.add(time, 50);
    meter_.advance(time + milliseconds(99));
  }
  EXPECT_NEAR(*meter_.load().share, 0.5, 0.001);
}

TEST_F(LoadMeterTest, AFrameThatIsStampedLongAgoCountsAllTheSame) {
  run(seconds(2), 500'000, 100, 0.0001);
  for (int i = 0; i < 100; ++i) {
    meter_.add(now_ - seconds(1), 50);
  }
  run(milliseconds(500), 500'000, 100, 0.0001);
  EXPECT_NEAR(meter_.load().bits_per_s, 5000, 200);
  EXPECT_NEAR(meter_.load().frames_per_s, 100, 2);
}

TEST_F(LoadMeterTest, TheTenthInWhichItBeganCountsForNothing) {
  meter_.set_bitrate(1'000'000);
  now_ += milliseconds(60);
  run(milliseconds(350), 1'000'000, 100, 0.5);
  EXPECT_NEAR(*meter_.load().share, 0.5, 0.002);
}

TEST_F(LoadMeterTest, ABurstInAFreshMeterIsNoPeakOfASecond) {
  meter_.set_bitrate(1'000'000);
  run(milliseconds(200), 1'000'000, 100, 1.0);
  run(seconds(2), 1'000'000, 100, 0.0001);
  EXPECT_LT(*meter_.load().peak_share, 0.25);
}

TEST_F(LoadMeterTest, ASilenceLongerThanItsMemoryIsIdle) {
  run(seconds(2), 500'000, 100, 1.0);
  meter_.advance(now_ + std::chrono::hours(1));
  EXPECT_EQ(meter_.load().bits_per_s, 0);
  EXPECT_EQ(meter_.load().frames_per_s, 0);
}

TEST_F(LoadMeterTest, ABurstThatIsFollowedByALongSilenceIsThePeak) {
  for (const auto silence : {milliseconds(1500), milliseconds(1700), milliseconds(5000)}) {
    meter_ = {};
    meter_.set_bitrate(500'000);
    run(seconds(2), 500'000, 100, 0.0001);
    const Timestamp end = now_ + milliseconds(900);
    for (; now_ < end; now_ += microseconds(200)) {
      meter_.add(now_, 100);
    }
    now_ += silence;
    meter_.advance(now_);
    EXPECT_NEAR(*meter_.load().peak_share, 0.9, 0.01) << silence.count();
    EXPECT_LT(*meter_.load().share, 0.91) << silence.count();
  }
}

TEST_F(LoadMeterTest, AnotherBitRateBeginsAnew) {
  meter_.set_bitrate(1'000'000);
  run(seconds(2), 1'000'000, 100, 0.9);
  meter_.set_bitrate(1'000'000);
  EXPECT_NEAR(*meter_.load().peak_share, 0.9, 0.001);
  meter_.set_bitrate(125'000);
  EXPECT_EQ(*meter_.load().peak_share, 0);
  run(seconds(2), 125'000, 100, 0.5);
  EXPECT_NEAR(*meter_.load().peak_share, 0.5, 0.01);
}

TEST_F(LoadMeterTest, AClockThatIsSetBackOrForthIsFollowed) {
  meter_.set_bitrate(500'000);
  for (const Timeout jump : {Timeout(-std::chrono::hours(1)), Timeout(std::chrono::hours(2)),
                             Timeout(-milliseconds(1000)), Timeout(-milliseconds(300))}) {
    run(seconds(2), 500'000, 100, 0.5);
    now_ += jump;
    meter_.advance(now_);
    run(seconds(3), 500'000, 100, 0.25);
    EXPECT_NEAR(*meter_.load().share, 0.25, 0.001) << jump.count();
    EXPECT_LE(*meter_.load().peak_share, 0.51);
  }
}

TEST_F(LoadMeterTest, ClearForgetsThePeak) {
  meter_.set_bitrate(500'000);
  run(seconds(2), 500'000, 100, 1.0);
  meter_.clear();
  EXPECT_EQ(*meter_.load().peak_share, 0);
  run(seconds(2), 500'000, 100, 0.25);
  EXPECT_NEAR(*meter_.load().peak_share, 0.25, 0.01);
}

}  // namespace
}  // namespace roio::cli
