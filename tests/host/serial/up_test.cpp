// Frames from the bridge: their order, their losses, their times; and answers that make no sense.
#include <algorithm>

#include "line.hpp"

namespace roio::test {
namespace {

std::uint64_t told(const Line& line) {
  std::uint64_t lost = 0;
  for (const auto& one : line.arrived) {
    lost += one.lost_before;
  }
  return lost;
}

TEST(SerialUp, FramesOfEveryKindArrive) {
  Line line;
  line.open();
  const std::vector<Frame> frames{{0x123, FrameKind::standard, 2, {0, 0}},
                                  {0x7FF, FrameKind::standard_remote, 8, {}},
                                  {0x1FFFFFFF, FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
                                  {0, FrameKind::extended_remote, 0, {}}};
  for (const Frame& frame : frames) {
    line.bridge.hear(frame, line.now);
  }
  line.run_for(10ms);
  ASSERT_EQ(line.arrived.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = line.arrived[i].frame;
    EXPECT_EQ(tagged_id(frame), tagged_id(frames[i]));
    EXPECT_EQ(frame.length, frames[i].length);
    EXPECT_TRUE(std::equal(frame.data, frame.data + 8, frames[i].data));
    EXPECT_EQ(line.arrived[i].lost_before, 0U);
  }
}

TEST(SerialUp, AGapIsToldWithTheNextFrame) {
  Line line;
  line.open();
  line.bridge.hear(numbered(0), line.now);
  line.bridge.hear(numbered(1), line.now, false);
  line.bridge.hear(numbered(2), line.now, false);
  line.bridge.hear(numbered(3), line.now);
  line.bridge.hear(numbered(4), line.now);
  line.run_for(10ms);
  ASSERT_EQ(line.arrived.size(), 3U);
  EXPECT_EQ(line.arrived[1].lost_before, 2U);
  EXPECT_EQ(line.arrived[2].lost_before, 0U);
  EXPECT_EQ(line.session.lost(), 2U);
}

TEST(SerialUp, ARecordThatTheLineRepeatsIsDeliveredOnce) {
  Line line;
  line.open();
  for (std::uint32_t i = 0; i < 3; ++i) {
    line.bridge.hear(numbered(i), line.now);
  }
  const auto copy = line.bridge.out;  // all three, and then all three again
  line.bridge.out.insert(line.bridge.out.end(), copy.begin(), copy.end());
  line.run_for(2ms);
  line.bridge.hear(numbered(3), line.now);
  line.run_for(200ms);
  ASSERT_EQ(line.arrived.size(), 4U);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(number_of(line.arrived[i].frame), i);
    EXPECT_EQ(line.arrived[i].lost_before, 0U);
  }
  EXPECT_EQ(line.session.counters().damaged, 3U);
  EXPECT_EQ(line.session.lost(), 0U);
}

// The sequence comes again after 255 that were lost; the time does not.
TEST(SerialUp, TheSameFrame256LaterIsAnotherOne) {
  Line line;
  line.open();
  line.bridge.hear(numbered(7), line.now);
  line.run_for(10ms);
  for (int i = 0; i < 255; ++i) {
    line.bridge.hear(numbered(7), line.now, false);
  }
  line.bridge.hear(numbered(7), line.now);
  line.run_for(150ms);
  EXPECT_EQ(line.arrived.size(), 2U);
  EXPECT_EQ(line.session.lost(), 255U);
  EXPECT_EQ(line.session.counters().damaged, 0U);
}

struct LossCase {
  const char* why;
  std::uint32_t lost;
};

TEST(SerialUp, StatusTellsOfLossesThatASequenceDoesNotShow) {
  const LossCase cases[] = {{"as much as a sequence shows", 255},
                            {"all of its values", 256},
                            {"one more", 257},
                            {"many times that", 100'000}};
  for (const LossCase& row : cases) {
    Line line;
    line.open();
    line.bridge.hear(numbered(0), line.now);
    for (std::uint32_t i = 0; i < row.lost; ++i) {
      line.bridge.hear(numbered(1), line.now, false);
    }
    line.bridge.hear(numbered(2), line.now);
    line.run_for(150ms);
    line.bridge.hear(numbered(3), line.now);
    line.run_for(10ms);
    EXPECT_EQ(line.session.lost(), row.lost) << row.why;
    EXPECT_EQ(line.arrived.size(), 3U) << row.why;
    EXPECT_EQ(told(line), row.lost) << row.why;
    EXPECT_EQ(line.session.counters().damaged, 0U) << row.why;
  }
}

TEST(SerialUp, WhatASessionMissedAtItsEndIsToldByTheNext) {
  Line line;
  line.open();
  line.bridge.hear(numbered(0), line.now);
  line.run_for(10ms);
  bool dead = true;
  line.up_fault = [&dead](std::uint8_t byte) { return dead ? std::nullopt : std::optional(byte); };
  line.down_fault = line.up_fault;
  for (int i = 0; i < 1000; ++i) {
    line.bridge.hear(numbered(1), line.now);
    line.run_for(1ms);
  }
  dead = false;
  ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions == 2; }));
  line.bridge.hear(numbered(2), line.now);
  line.run_for(300ms);
  EXPECT_EQ(line.session.lost(), 1000U);
  ASSERT_EQ(line.arrived.size(), 2U);
  EXPECT_EQ(line.arrived[1].lost_before, 1000U);
}

TEST(SerialUp, AResetTellsNothing) {
  Line line;
  line.open();
  for (std::uint32_t i = 0; i < 300; ++i) {
    line.bridge.hear(numbered(i), line.now);
    line.run_for(1ms);
  }
  line.bridge.reset();
  ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions == 2; }));
  line.bridge.hear(numbered(300), line.now);
  line.run_for(200ms);
  EXPECT_EQ(line.arrived.size(), 301U);
  EXPECT_EQ(line.session.lost(), 0U);
}

TEST(SerialUp, AWelcomeThatWasLostLosesNoCount) {
  Line line;
  line.bridge.may_send = losing(serial::Up::welcome);
  line.session.begin(line.now);
  ASSERT_TRUE(line.run_until([&] { return line.bridge.hellos == 1; }));
  for (std::uint32_t i = 0; i < 3; ++i) {
    line.bridge.hear(numbered(i), line.now);
  }
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }));
  line.bridge.hear(numbered(3), line.now);
  line.run_for(200ms);
  ASSERT_EQ(line.arrived.size(), 1U);
  EXPECT_EQ(line.arrived[0].lost_before, 3U);
}

TEST(SerialUp, AWelcomeThatIsRepeatedChangesNothing) {
  Line line;
  line.open();
  line.bridge.hear(numbered(0), line.now);
  line.run_for(10ms);
  for (const std::uint8_t byte :
       record_of({0xE1, 0, 1, 0, 0, static_cast<std::uint8_t>(line.nonce >> 8),
                  static_cast<std::uint8_t>(line.nonce)},
                 0)) {
    line.bridge.take(byte, line.now);
  }
  line.bridge.hear(numbered(1), line.now);
  line.run_for(200ms);
  EXPECT_EQ(line.arrived.size(), 2U);
  EXPECT_EQ(line.session.lost(), 0U);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.phase(), Phase::ready);
}

// --- answers that make no sense ------------------------------------------------------------------

struct NonsenseCase {
  const char* why;
  Bytes body;
};

TEST(SerialUp, WhatMakesNoSenseIsCountedAndLeft) {
  const NonsenseCase cases[] = {
      {"STATUS too short", {0xF2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
      {"STATUS too long", {0xF2, 0, 0xFF, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
      {"STATUS of no state", {0xF2, 0, 0xFF, 0, 0, 0, 0, 0, 0, 0, 6, 0, 0}},
      {"STATUS whose time goes back", {0xF2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}},
      {"STATUS with fewer frames due than came", {0xF2, 3, 0x0F, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0}},
      {"COUNTERS too short", {0xF3, 3, 0, 0, 0, 0}},
      {"COUNTERS of none", {0xF3, 3, 0}},
      {"COUNTERS past the last", {0xF3, 3, 10, 0, 0, 0, 0, 0, 0, 0, 0}},
      {"COUNTERS that are too many", Bytes{0xF3, 3, 0} + Bytes(20, 0)},
      {"RESULTS too short", {0xF4, 3, 0, 0, 0, 0, 0}},
      {"RESULTS of a frame that was not sent", {0xF4, 3, 1, 0, 0, 0, 0, 0}},
      {"RESULTS of a frame long ago", {0xF4, 3, 0xFF, 0, 0, 0, 0, 0}},
      {"REPLY too short", {0xF5, 3, 1}},
      {"REPLY too long", {0xF5, 3, 1, 0, 0}},
      {"ECHOED that nobody asked for", {0xF6, 3, 1, 2, 3}},
      {"ECHOED of nothing", {0xF6, 3}},
      {"an operation that is none", {0xF7, 3}},
      {"an operation of the other direction", {0xE2, 3, 0}},
      {"a frame too short", {0x90, 0, 0x40, 0x0A, 3, 0}},
      {"a frame too long", {0x90, 0, 0x40, 0x0A, 3, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {"a standard identifier of 12 bits", {0x00, 0, 0x08, 0x00, 3, 0, 0}},
      {"an error report", {0x20, 0, 0, 4, 3, 0, 0}},
      {"a remote frame without a length", {0xC0, 0, 0, 4, 3, 0, 0}},
      {"a remote frame of 9 bytes", {0xC0, 0, 0, 4, 3, 0, 0, 9}},
  };
  for (const NonsenseCase& row : cases) {
    Line line;
    line.open();
    for (std::uint32_t i = 0; i < 3; ++i) {
      line.bridge.hear(numbered(i), line.now);
    }
    line.run_for(1ms);
    ASSERT_EQ(line.arrived.size(), 3U) << row.why;
    line.bridge.send_body(row.body, line.bridge.session());
    line.run_for(2ms);
    EXPECT_EQ(line.session.counters().damaged, 1U) << row.why;
    EXPECT_EQ(line.session.phase(), Phase::ready) << row.why;
    EXPECT_EQ(line.arrived.size(), 3U) << row.why;
  }
}

TEST(SerialUp, AWelcomeThatMakesNoSenseOpensNoSession) {
  Line line;
  line.bridge.window = 17;
  line.session.begin(line.now);
  line.run_for(300ms);
  EXPECT_EQ(line.session.phase(), Phase::calling);
  line.bridge.window = 16;
  line.bridge.mode = 3;
  line.run_for(300ms);
  EXPECT_EQ(line.session.phase(), Phase::calling);
}

TEST(SerialUp, RecordsOfAnotherSessionAreDamagedOnes) {
  Line line;
  line.open();
  line.bridge.send_body({0x90, 0, 0x40, 0x0A, 0, 0, 0}, line.bridge.session() + 1);
  line.run_for(2ms);
  EXPECT_EQ(line.session.counters().damaged, 1U);
  EXPECT_TRUE(line.arrived.empty());
}

// --- times ---------------------------------------------------------------------------------------

struct ClockCase {
  const char* why;
  std::uint32_t first_tick;
  double speed;
};

TEST(SerialTime, IsTheBridgesByThePcsClock) {
  const ClockCase cases[] = {{"a crystal that is right", 0, 1},
                             {"16 bits that wrap", 0xFF00, 1},
                             {"32 bits that wrap", 0xFFFFFF00, 1},
                             {"a resonator that is slow", 5, 0.995},
                             {"a resonator that is fast", 77777, 1.005}};
  for (const ClockCase& row : cases) {
    Line line;
    line.now = 0s;
    line.bridge.first_tick = row.first_tick;
    line.bridge.clock_speed = row.speed;
    line.open();
    line.run_for(500ms);
    std::vector<Time> heard_at;
    std::mt19937 pause(3);
    for (std::uint32_t i = 0; i < 300; ++i) {
      line.run_for(Time(pause() % 100'000'000));
      heard_at.push_back(line.now);
      line.bridge.hear(numbered(i), line.now);
      if (i % 5 == 0) {  // and some close behind
        heard_at.push_back(line.now);
        line.bridge.hear(numbered(i), line.now);
      }
    }
    line.run_for(10ms);
    ASSERT_EQ(line.arrived.size(), heard_at.size()) << row.why;
    Time last{0};
    for (std::size_t i = 0; i < heard_at.size(); ++i) {
      const Time error = line.arrived[i].time - heard_at[i];
      // A record takes 0.2 ms, the base of the estimate is a STATUS; the drift of 100 ms comes on
      // top.
      EXPECT_LT(std::chrono::abs(error), 2ms) << row.why << " frame " << i;
      EXPECT_GE(line.arrived[i].time, last) << row.why;
      last = line.arrived[i].time;
    }
  }
}

TEST(SerialTime, OfFramesThatWaitedIsWhenTheyWereRead) {
  Line line;
  line.open();
  line.run_for(500ms);
  const Time heard_at = line.now;
  for (std::uint32_t i = 0; i < 100; ++i) {
    line.bridge.hear(numbered(i), line.now);
  }
  line.run_for(100ms);
  ASSERT_EQ(line.arrived.size(), 100U);
  EXPECT_LT(std::chrono::abs(line.arrived.back().time - heard_at), 2ms);
}

TEST(SerialTime, IsTheArrivalsBeforeTheBridgeHasSaidItsOwn) {
  Line line;
  line.bridge.may_send = losing(serial::Up::status, 1000);
  line.open();
  line.bridge.hear(numbered(1), line.now);
  const Time heard_at = line.now;
  line.run_for(10ms);
  ASSERT_EQ(line.arrived.size(), 1U);
  EXPECT_LT(line.arrived[0].time - heard_at, 1ms);
  EXPECT_GT(line.arrived[0].time, heard_at);
}

TEST(SerialTime, DoesNotGoBackWithAnotherSession) {
  Line line;
  line.open();
  line.bridge.hear(numbered(1), line.now);
  line.run_for(10ms);
  line.bridge.reset();
  line.bridge.first_tick = 0x80000000;
  ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions == 2; }));
  line.bridge.hear(numbered(2), line.now);
  line.run_for(300ms);
  line.bridge.hear(numbered(3), line.now);
  line.run_for(10ms);
  ASSERT_EQ(line.arrived.size(), 3U);
  EXPECT_GT(line.arrived[1].time, line.arrived[0].time);
  EXPECT_GT(line.arrived[2].time - line.arrived[1].time, 290ms);
}

}  // namespace
}  // namespace roio::test
