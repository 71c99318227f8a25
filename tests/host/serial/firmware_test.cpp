// The session and the bridge's own image on a simulated board: rates, full buses, times. What goes
// wrong is firmware_fault_test.cpp's.
#include <iostream>

#include "board_line.hpp"

namespace roio::test {
namespace {

TEST(SerialFirmware, OpensAtEveryRate) {
  for (std::uint8_t i = 0; i < serial::rate_count; ++i) {
    BoardLine line({.line_rate_bps = serial::rate_bps(i)});
    line.open();
    EXPECT_EQ(line.session.line_rate_bps(), serial::rate_bps(i));
    EXPECT_EQ(line.session.counters().failed_trials, 0U);
    EXPECT_EQ(line.session.counters().damaged, 0U);
    EXPECT_EQ(line.session.info().board, BridgeBoard::uno);
    EXPECT_EQ(line.session.info().osc_khz, 16'000);
    EXPECT_EQ(line.session.info().state, BridgeState::active);
    EXPECT_TRUE(line.session.info().interrupt_wired);
  }
}

TEST(SerialFirmware, OpensOnABusThatIsFull) {
  BoardLine line;
  Flood flood(line);
  line.session.begin(line.now());
  EXPECT_TRUE(line.run_until([&] { return line.is_ready(); }, 2s));
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
}

TEST(SerialFirmware, LosesNothingOfAFullBusOf500kAt1M) {
  BoardLine line;
  line.open();
  Flood flood(line);
  line.run_for(2s);
  flood.stop();
  line.run_for(200ms);
  expect_all_told(line, flood.sent());
  EXPECT_EQ(line.session.lost(), 0U);
  EXPECT_GT(flood.sent(), 5000U);
}

TEST(SerialFirmware, FillsABusOf500kAt1M) {
  BoardLine line;
  line.open();
  Source source(line);
  const sim::BusStatistics before = line.bus.statistics();
  const Time start = line.now();
  line.at_each_look = [&] { source.fill(); };
  line.run_for(1s);
  const double load = std::chrono::duration<double>(line.bus.statistics().busy - before.busy) /
                      std::chrono::duration<double>(line.now() - start);
  line.at_each_look = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 1s));
  expect_on_bus_in_order(line);
  EXPECT_EQ(line.on_bus.size(), source.offered);
  EXPECT_EQ(line.session.down().sent, source.offered);
  EXPECT_EQ(line.session.down().resent, 0U);
  std::cout << "load of the bus: " << load << '\n';
  EXPECT_GT(load, 0.7) << "more than the processor can do (bench/figures.md)";
}

TEST(SerialFirmware, BothWaysAtOnceNothingIsLost) {
  BoardLine line;
  line.open();
  Flood flood(line);
  Source source(line);
  line.at_each_look = [&] { source.fill(); };
  line.run_for(2s);
  flood.stop();
  line.at_each_look = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 2s));
  line.run_for(200ms);
  expect_all_told(line, flood.sent());
  EXPECT_EQ(line.session.lost(), 0U);
  expect_on_bus_in_order(line);
  EXPECT_EQ(line.on_bus.size(), source.offered);
  EXPECT_EQ(line.session.down().sent, source.offered);
  EXPECT_EQ(line.session.down().resent, 0U);
  std::cout << "up " << flood.sent() << ", down " << source.offered << '\n';
}

TEST(SerialFirmware, WhatDoesNotFitIsCountedExactly) {
  BoardLine line({.line_rate_bps = 250'000});
  line.open();
  Flood flood(line);
  line.run_for(2s);
  flood.stop();
  line.run_for(300ms);
  expect_all_told(line, flood.sent());
  EXPECT_GT(line.session.lost(), 1000U);
  EXPECT_EQ(line.counters().dropped, line.session.lost());
  EXPECT_EQ(line.session.counters().sessions, 1U);
}

TEST(SerialFirmware, TimesAreWhenTheFramesWereOnTheBus) {
  BoardLine line;
  line.open();
  std::vector<Time> ended_at;
  line.node.on_sent([&](const Frame& /*frame*/) { ended_at.push_back(line.now()); });
  for (std::uint32_t i = 0; i < 50; ++i) {
    line.node.send(numbered(i));
    line.run_for(Time(7'300'000 * (i % 5 + 1)));
  }
  ASSERT_EQ(line.arrived.size(), ended_at.size());
  for (std::size_t i = 0; i < ended_at.size(); ++i) {
    EXPECT_LT(std::chrono::abs(line.arrived[i].time - ended_at[i]), 2ms) << i;
  }
}

// --- nothing old ---------------------------------------------------------------------------------

constexpr auto off = sim::Controller::Mode::off;
constexpr auto normal = sim::Controller::Mode::normal;

std::vector<Frame> some_frames(std::uint32_t count) {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    frames.push_back(numbered(i));
  }
  return frames;
}

std::uint64_t unsent(const SerialSession& session) {
  return session.down().not_sent + session.down().unknown + session.down().dropped;
}

TEST(SerialFirmware, WhatNobodyAcknowledgesIsOverInTimeWhereverItIs) {
  BoardLine line({.lifetime = 500ms});
  line.open();
  line.node.controller().set_mode(off);
  ASSERT_EQ(line.session.offer(some_frames(40), line.now()), 40U);  // line, board, window and lane
  line.run_for(440ms);
  EXPECT_EQ(unsent(line.session), 0U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 70ms));
  EXPECT_EQ(unsent(line.session), 40U);
  EXPECT_EQ(line.session.down().unknown, 0U) << "it is known that they were not sent";
  line.node.controller().set_mode(normal);
  line.run_for(2s);
  EXPECT_TRUE(line.on_bus.empty());
  EXPECT_EQ(line.counters().not_sent, line.session.down().not_sent);
}

TEST(SerialFirmware, NothingIsLateOnABusThatOthersHoldUp) {
  BoardLine line({.lifetime = 300ms});
  line.open();
  // Urgent frames of another node, without a gap: the bridge's never get through.
  bool holding = true;
  const Frame urgent{0x00000001, FrameKind::extended, 8, {}};
  line.node.on_sent([&](const Frame& /*frame*/) {
    if (holding) {
      line.node.send(urgent);
    }
  });
  line.node.send(urgent);
  line.node.send(urgent);
  ASSERT_EQ(line.session.offer(some_frames(20), line.now()), 20U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 400ms));
  holding = false;
  line.run_for(1s);
  EXPECT_EQ(line.on_bus.size(), line.session.down().sent);
  EXPECT_EQ(line.session.down().sent + unsent(line.session), 20U);
  EXPECT_LE(line.session.down().sent, 1U) << "at most what was on the wire";
}

TEST(SerialFirmware, AnotherRateForgetsWhatTheOldOneHadToSend) {
  BoardLine line({.lifetime = 30s});
  line.open();
  line.node.controller().set_mode(off);
  ASSERT_EQ(line.session.offer(some_frames(15), line.now()), 15U);
  line.run_for(200ms);
  bool replied = false;
  line.session.set_bus(500'000, BridgeMode::normal, line.now(),
                       [&](const Reply& reply) { replied = reply.ok(); });
  ASSERT_TRUE(line.run_until([&] { return replied && line.session.all_done(); }, 1s));
  EXPECT_EQ(unsent(line.session), 15U);
  EXPECT_LE(line.session.down().unknown, 3U) << "what the controller had";
  line.node.controller().set_mode(normal);
  line.run_for(2s);
  EXPECT_TRUE(line.on_bus.empty());
}

TEST(SerialFirmware, APcThatIsGoneLeavesNothingBehind) {
  BoardLine line({.lifetime = 30s});
  line.open();
  line.node.controller().set_mode(off);
  ASSERT_EQ(line.session.offer(some_frames(15), line.now()), 15U);
  line.run_for(200ms);
  line.bus.run_for(1s);  // killed
  line.node.controller().set_mode(normal);
  line.bus.run_for(2s);
  EXPECT_TRUE(line.on_bus.empty());
}

}  // namespace
}  // namespace roio::test
