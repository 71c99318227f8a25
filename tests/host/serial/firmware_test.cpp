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

}  // namespace
}  // namespace roio::test
