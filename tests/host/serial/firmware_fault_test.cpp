// The session and the bridge's own image, when something goes wrong: with the line, the board, the
// bus or the controller.
#include <iostream>

#include "board_line.hpp"

namespace roio::test {
namespace {

/// As a fault: no byte arrives.
std::optional<std::uint8_t> nothing(std::uint8_t /*byte*/) {
  return std::nullopt;
}

/// Frames both ways, as many as 115,200 bit/s carries, while something happens to the line.
class Traffic {
 public:
  explicit Traffic(BoardLine& line) : line_(line), source_(line) {
    line.at_each_look = [this, next = line.now()]() mutable {
      source_.fill();
      if (line_.now() >= next) {
        next += 4ms;
        line_.node.send({numbered_id(given_++, 0), FrameKind::extended, 0, {}});
      }
    };
  }
  void stop() {
    line_.at_each_look = nullptr;
    ASSERT_TRUE(line_.run_until([&] { return line_.session.all_done(); }, 2s));
    line_.run_for(200ms);
  }
  /// Each at most once, in order, and told truly.
  void expect_truth() const {
    ASSERT_NO_FATAL_FAILURE(expect_arrived_in_order(line_));
    expect_on_bus_in_order(line_);
    const serial::DownFrames::Counters& down = line_.session.down();
    EXPECT_EQ(down.sent + down.unknown + down.not_sent + down.dropped, source_.offered);
    EXPECT_GE(line_.on_bus.size(), down.sent);
    EXPECT_LE(line_.on_bus.size(), down.sent + down.unknown);
  }
  [[nodiscard]] std::uint32_t given() const { return given_; }

 private:
  BoardLine& line_;
  Source source_;
  std::uint32_t given_ = 0;
};

TEST(SerialFirmware, AResetInTheMiddleOfARecordIsOverWithinASecond) {
  BoardLine line;
  line.open();
  Traffic traffic(line);
  line.run_for(300ms);
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t sessions = line.session.counters().sessions;
    line.board.reset();
    ASSERT_TRUE(line.run_until(
        [&] { return line.session.counters().sessions > sessions && line.is_ready(); }, 1s));
    line.run_for(200ms);
  }
  traffic.stop();
  traffic.expect_truth();
  EXPECT_LE(line.session.down().unknown, 3 * serial::window);
}

TEST(SerialFirmware, AnUnpluggedLineIsBackWithinASecond) {
  BoardLine line;
  line.open();
  Traffic traffic(line);
  line.run_for(300ms);
  // For less than the bridge's patience with a silent PC, and for more.
  for (const Time away : {Time(50ms), Time(3s)}) {
    line.up_fault = line.down_fault = nothing;
    line.session.end();
    line.run_for(away);
    line.up_fault = line.down_fault = nullptr;
    line.session.begin(line.now());
    ASSERT_TRUE(line.run_until([&] { return line.is_ready(); }, 1s)) << away.count();
    line.run_for(300ms);
  }
  traffic.stop();
  traffic.expect_truth();
  EXPECT_EQ(line.arrived.size() + line.session.lost(), traffic.given());
}

TEST(SerialFirmware, CreditThatDoesNotComeIsMadeUpForWithinASecond) {
  BoardLine line;
  line.open();
  Traffic traffic(line);
  line.run_for(300ms);
  for (int i = 0; i < 6; ++i) {
    (i % 2 == 0 ? line.up_fault : line.down_fault) = nothing;
    line.run_for(150ms);  // the window is long full
    line.up_fault = line.down_fault = nullptr;
    const std::size_t on_bus = line.on_bus.size();
    ASSERT_TRUE(line.run_until([&] { return line.on_bus.size() > on_bus + 20; }, 1s)) << i;
  }
  traffic.stop();
  traffic.expect_truth();
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.down().unknown, 0U);
  EXPECT_GT(line.session.down().resent, 0U);
  EXPECT_EQ(line.arrived.size() + line.session.lost(), traffic.given());
}

/// Changes, loses and makes up bytes.
auto faults(std::uint32_t seed, double probability) {
  return [random = std::mt19937(seed), probability](std::uint8_t byte) mutable {
    if (std::uniform_real_distribution<>(0, 1)(random) >= probability) {
      return std::optional(byte);
    }
    return random() % 2 == 0 ? std::nullopt : std::optional(static_cast<std::uint8_t>(random()));
  };
}

TEST(SerialFirmware, ALineWithErrorsLosesNothingUncounted) {
  for (const double probability : {1e-4, 1e-3}) {
    SCOPED_TRACE(probability);
    BoardLine line;
    line.open();
    line.up_fault = faults(1, probability);
    line.down_fault = faults(2, probability);
    Flood flood(line);
    Source source(line);
    line.at_each_look = [&] { source.fill(); };
    line.run_for(3s);
    flood.stop();
    line.at_each_look = nullptr;
    line.up_fault = nullptr;
    line.down_fault = nullptr;
    ASSERT_TRUE(line.run_until([&] { return line.is_ready() && line.session.all_done(); }, 5s));
    line.run_for(300ms);
    expect_all_told(line, flood.sent());
    expect_on_bus_in_order(line);
    const serial::DownFrames::Counters& down = line.session.down();
    EXPECT_EQ(down.sent + down.unknown, source.offered);
    EXPECT_GE(line.on_bus.size(), down.sent);
    EXPECT_LE(line.on_bus.size(), down.sent + down.unknown);
    std::cout << probability << ": damaged " << line.session.counters().damaged << ", lost "
              << line.session.lost() << " of " << flood.sent() << ", resent " << down.resent
              << ", unknown " << down.unknown << " of " << source.offered << ", sessions "
              << line.session.counters().sessions << ", rate " << line.session.line_rate_bps()
              << ", overflows " << line.session.bridge_counters().overflows << '\n';
  }
}

TEST(SerialFirmware, AWindowThatNobodyAcknowledgesEndsNoSession) {
  BoardLine line({.lifetime = forever});
  line.open();
  line.node.controller().set_mode(sim::Controller::Mode::off);
  Source source(line);
  line.at_each_look = [&] { source.fill(); };
  line.run_for(3s);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.info().state, BridgeState::passive);
  EXPECT_EQ(line.session.down().resent, 0U);
  line.node.controller().set_mode(sim::Controller::Mode::normal);
  line.at_each_look = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 2s));
  EXPECT_EQ(line.session.down().sent, source.offered);
}

TEST(SerialFirmware, WithoutAControllerFramesComeToTheirEnd) {
  BoardLine line({.lifetime = 500ms});
  line.open();
  line.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  ASSERT_TRUE(
      line.run_until([&] { return line.session.info().state == BridgeState::no_controller; }, 2s));
  ASSERT_EQ(line.session.offer(std::vector<Frame>(20, numbered(1)), line.now()), 20U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 1s));
  EXPECT_EQ(line.session.down().not_sent + line.session.down().dropped, 20U);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  line.board.set_chip_fault(sim::SpiWire::Fault::none);
  line.run_for(1s);
  EXPECT_TRUE(line.on_bus.empty());
}

TEST(SerialFirmware, WithoutAControllerFramesWait) {
  BoardLine line({.lifetime = forever});
  line.open();
  line.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  ASSERT_TRUE(
      line.run_until([&] { return line.session.info().state == BridgeState::no_controller; }, 2s));
  const std::vector<Frame> frames(20, numbered(1));
  ASSERT_EQ(line.session.offer(frames, line.now()), 20U);
  line.run_for(3s);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  line.board.set_chip_fault(sim::SpiWire::Fault::none);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 2s));
  EXPECT_EQ(line.session.down().sent, 20U);
  EXPECT_EQ(line.on_bus.size(), 20U);
}

TEST(SerialFirmware, ACrystalThatTurnsUpLateIsKnown) {
  BoardLine line({.bitrate_bps = 125'000, .mode = BridgeMode::listen});
  line.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  line.open();
  EXPECT_EQ(line.session.info().state, BridgeState::no_controller);
  EXPECT_EQ(line.session.info().osc_khz, 0);
  line.board.set_chip_fault(sim::SpiWire::Fault::none);
  EXPECT_TRUE(line.run_until([&] { return line.session.info().osc_khz == 16'000; }, 1s));
  EXPECT_TRUE(line.session.info().interrupt_wired);
  line.run_for(1s);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.info().state, BridgeState::active);
}

/// Its INT line stays low meanwhile, for it still holds frames.
TEST(SerialFirmware, AControllerLostOnAFullBusIsTakenUpAgain) {
  for (const auto fault : {sim::SpiWire::Fault::stuck_high, sim::SpiWire::Fault::stuck_low}) {
    for (const Time span : {Time(50us), Time(150ms)}) {
      SCOPED_TRACE(span.count());
      BoardLine line;
      line.open();
      line.run_for(700ms);
      Flood flood(line);
      line.run_for(100ms);
      line.board.set_chip_fault(fault);
      line.run_for(span);
      line.board.set_chip_fault(sim::SpiWire::Fault::none);
      line.run_for(700ms);
      const std::size_t arrived = line.arrived.size();
      line.run_for(200ms);
      EXPECT_GT(line.arrived.size(), arrived + 500);
      EXPECT_EQ(line.session.counters().sessions, 1U);
    }
  }
}

}  // namespace
}  // namespace roio::test
