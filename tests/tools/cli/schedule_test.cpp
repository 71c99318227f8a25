#include "record/schedule.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <ostream>
#include <vector>

namespace roio::cli {
namespace {

using std::chrono::milliseconds;

constexpr int none = -1;  // a frame without a time
constexpr std::int64_t hour_ms = 3'600'000;

struct Row {
  const char* name;
  std::vector<std::int64_t> in_log_ms;
  std::vector<std::int64_t> due_ms;  ///< Since the first frame was there to be sent.
  std::optional<double> speed = 1.0;
  std::optional<milliseconds> gap{};
  std::uint64_t steps_back = 0;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.name;
}

class ScheduleTable : public testing::TestWithParam<Row> {};

// Each frame is there to be sent when the one before it was due.
TEST_P(ScheduleTable, SaysWhenFramesAreDue) {
  const Schedule::Clock::time_point start(std::chrono::hours(1));
  Schedule schedule({GetParam().speed, GetParam().gap});
  auto now = start;
  std::vector<std::int64_t> due_ms;
  for (const std::int64_t time_ms : GetParam().in_log_ms) {
    const auto time =
        time_ms == none ? std::nullopt : std::optional(Timestamp(milliseconds(time_ms)));
    now = schedule.due(time, now);
    due_ms.push_back(std::chrono::duration_cast<milliseconds>(now - start).count());
  }
  EXPECT_EQ(due_ms, GetParam().due_ms);
  EXPECT_EQ(schedule.steps_back(), GetParam().steps_back);
}

const Row rows[] = {
    {"the first is due at once, whatever its time", {1'436'509'052'249}, {0}},
    {"the others as far from it as in the log", {1000, 1001, 1250, 5000}, {0, 1, 250, 4000}},
    {"twice as fast", {1000, 1001, 1250, 5000}, {0, 0, 125, 2000}, 2},
    {"four times as slow", {1000, 1001, 1250}, {0, 4, 1000}, 0.25},
    {"as fast as the bus takes them", {1000, 5000, hour_ms, 0}, {0, 0, 0, 0}, std::nullopt},
    {"a pause of hours is one", {0, 10 * hour_ms}, {0, 10 * hour_ms}},
    {"but not when it is cut, and goes on from there",
     {0, 10 * hour_ms, 10 * hour_ms + 5, 20 * hour_ms},
     {0, 100, 105, 205},
     1,
     milliseconds(100)},
    {"a pause as long as the longest is not cut",
     {0, 100, 201},
     {0, 100, 200},
     1,
     milliseconds(100)},
    {"what is cut is the pause as it is waited",
     {0, 300, 800},
     {0, 150, 350},
     2,
     milliseconds(200)},
    {"no pause at all", {0, 300, 800}, {0, 0, 0}, 1, milliseconds(0)},
    {"of several buses, a little out of order, none waits for time that has passed, and the others "
     "keep theirs",
     {0, 100, 90, 110, 105, 200},
     {0, 100, 100, 110, 110, 200}},
    {"out of order by a second is the most", {5000, 4000, 6000}, {0, 0, 1000}},
    {"by more is a clock that was set, or another log",
     {5000, 3999, 4999, 5000},
     {0, 0, 1000, 1001},
     1,
     {},
     1},
    {"each time that it is",
     {hour_ms, 0, 500, hour_ms, 0},
     {0, 0, 500, hour_ms, hour_ms},
     1,
     {},
     2},
    {"without a time, it follows the one before", {none, 50, none, 80, none}, {0, 0, 0, 30, 30}},
    {"a hundred years at most, and no overflow",
     {0, 9'223'372'036'000},
     {0, 876'000 * hour_ms},
     0.001},
};

INSTANTIATE_TEST_SUITE_P(All, ScheduleTable, testing::ValuesIn(rows));

TEST(Schedule, WhatIsLateIsDueWhenItWas) {
  const Schedule::Clock::time_point start(std::chrono::hours(1));
  Schedule schedule(PlayPace{});
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(0)), start), start);
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(10)), start + milliseconds(500)),
            start + milliseconds(10));
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(600)), start + milliseconds(500)),
            start + milliseconds(600));
}

TEST(Schedule, ALogThatBeginsAgainFollowsItsEnd) {
  const Schedule::Clock::time_point start(std::chrono::hours(1));
  Schedule schedule(PlayPace{});
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(5000)), start), start);
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(9000)), start), start + milliseconds(4000));
  schedule.begin_again();
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(5000)), start), start + milliseconds(4000));
  EXPECT_EQ(schedule.due(Timestamp(milliseconds(5001)), start), start + milliseconds(4001));
  EXPECT_EQ(schedule.steps_back(), 0U);
}

}  // namespace
}  // namespace roio::cli
