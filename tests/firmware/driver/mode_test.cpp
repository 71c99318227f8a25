// Changing modes: out of the bus and back without begin(), and sleep, from which the bus wakes.
#include "rig.hpp"

namespace roio::test {
namespace {

using mcp2515::Mode;
using ChipMode = sim::Mcp2515Chip::OperationMode;

TEST(ChangeMode, ListensAndTakesPartAgain) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.change_mode(Mode::listen_only), Status::ok);
  EXPECT_EQ(rig.chip.mode(), ChipMode::listen_only);
  EXPECT_EQ(rig.can.send(numbered(1)), Status::wrong_mode);
  ASSERT_EQ(rig.can.change_mode(Mode::normal), Status::ok);
  expect_it_works(rig);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(rig.can.poll(), Status::ok) << "the mode is the one that is expected";
  }
}

TEST(ChangeMode, OnABusThatIsNeverIdleSaysSoAndStops) {
  Rig<> rig;
  rig.begin();
  rig.bus.hold_dominant(true);
  rig.bus.run_for(milliseconds(1));
  EXPECT_EQ(rig.can.change_mode(Mode::listen_only), Status::wrong_mode);
  EXPECT_FALSE(rig.can.running());
  EXPECT_EQ(rig.can.counters().chip_losses, 0U) << "the chip is there";
  rig.bus.hold_dominant(false);
  EXPECT_EQ(rig.can.begin(plain_config()), Status::ok);
  expect_it_works(rig);
}

TEST(ChangeMode, NeedsAChipThatIsRunning) {
  Rig<> rig;
  EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::no_chip);
  EXPECT_EQ(rig.can.change_mode(Mode::asleep), Status::no_chip);
  rig.begin();
  EXPECT_EQ(rig.can.stop(), Status::ok);
  EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::no_chip);
}

TEST(ChangeMode, BeginTakesNoModeThatRests) {
  for (const Mode mode : {Mode::asleep, Mode::configuration}) {
    Rig<> rig;
    EXPECT_EQ(rig.can.begin(plain_config(mode)), Status::bad_argument);
    EXPECT_EQ(rig.spent().first, 0U);
  }
}

/// Modes in which the chip is off the bus and keeps its setup.
class Rest : public testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(, Rest, testing::Values(Mode::asleep, Mode::configuration),
                         [](const auto& row) {
                           return row.param == Mode::asleep ? "Asleep" : "InConfigurationMode";
                         });

TEST_P(Rest, TheChipIsOffTheBusAndKeepsItsSetup) {
  Rig<true> rig;
  rig.begin();
  ASSERT_EQ(rig.can.change_mode(GetParam()), Status::ok);
  EXPECT_EQ(static_cast<int>(rig.chip.mode()) << 5, static_cast<int>(GetParam()));
  EXPECT_FALSE(rig.can.running());
  Frame frame{};
  rig.mark();
  EXPECT_EQ(rig.can.poll(), Status::no_chip);
  EXPECT_EQ(rig.can.receive(frame), Status::no_chip);
  EXPECT_EQ(rig.can.send(numbered(1)), Status::no_chip);
  EXPECT_EQ(rig.spent().first, 0U) << "it is left alone";
  ASSERT_EQ(rig.can.change_mode(Mode::normal), Status::ok);
  EXPECT_TRUE(rig.can.running());
  expect_it_works(rig);
  EXPECT_TRUE(rig.can.line_is_on());
  EXPECT_EQ(rig.chip.peek(0x2B), 0x03) << "CANINTE: as begin() left it";
  EXPECT_EQ(rig.can.counters().chip_losses, 0U);
  EXPECT_TRUE(rig.chip.violations().empty()) << rig.chip.violations().front().what;
}

TEST_P(Rest, ComesWhenAllIsSent) {
  Rig<false, 0, 4> rig;
  rig.begin();
  for (std::uint8_t i = 0; i < 4; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i)), Status::ok);
  }
  Status status = rig.can.change_mode(GetParam());
  EXPECT_EQ(status, Status::full);
  EXPECT_TRUE(rig.can.running()) << "and it goes on";
  for (int tries = 0; tries < 100 && status == Status::full; ++tries) {
    rig.bus.run_for(microseconds(100));
    ASSERT_EQ(rig.can.poll(), Status::ok);
    status = rig.can.change_mode(GetParam());
  }
  EXPECT_EQ(status, Status::ok);
  EXPECT_EQ(rig.peer_received.size(), 4U);
  EXPECT_EQ(rig.can.counters().sent, 4U);
}

TEST_P(Rest, WithoutPowerTheChipForgetsAndThatIsTold) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.change_mode(GetParam()), Status::ok);
  rig.chip.power_cycle();
  rig.bus.run_for(milliseconds(1));
  EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::no_chip);
  EXPECT_EQ(rig.can.counters().chip_losses, 1U);
  EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::no_chip);
  EXPECT_EQ(rig.can.counters().chip_losses, 1U) << "once";
  rig.begin();
  expect_it_works(rig);
}

TEST_P(Rest, EndsWithStopAndWithBegin) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.change_mode(GetParam()), Status::ok);
  EXPECT_EQ(rig.can.stop(), Status::ok);
  EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::no_chip);
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  ASSERT_EQ(rig.can.change_mode(GetParam()), Status::ok);
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  expect_it_works(rig);
}

// --- sleep ---------------------------------------------------------------------------------------

TEST(Sleep, EndsByTheBusWithTheFrameThatWakesItLost) {
  Rig<true> rig;
  rig.begin();
  sim::HostNode witness(rig.bus, 500'000);  // acknowledges
  ASSERT_EQ(rig.can.change_mode(Mode::asleep), Status::ok);
  rig.bus.run_for(milliseconds(100));
  EXPECT_TRUE(rig.can.is_asleep());
  EXPECT_FALSE(rig.wire.interrupt_line_is_low());
  rig.peer_sends({numbered('A')});
  EXPECT_TRUE(rig.wire.interrupt_line_is_low()) << "which can wake a processor, too";
  EXPECT_FALSE(rig.can.is_asleep());
  EXPECT_EQ(rig.chip.mode(), ChipMode::listen_only);
  rig.peer_sends({numbered('B')});
  ASSERT_EQ(rig.can.change_mode(Mode::normal), Status::ok);
  EXPECT_EQ(rig.receive_all(), std::vector{numbered('B')});
  EXPECT_FALSE(rig.wire.interrupt_line_is_low());
  expect_it_works(rig);
  EXPECT_TRUE(rig.chip.violations().empty()) << rig.chip.violations().front().what;
}

TEST(Sleep, OfTheOnlyListenerLosesNothingForTheSenderTriesAgain) {
  Rig<true> rig;
  rig.begin();
  ASSERT_EQ(rig.can.change_mode(Mode::asleep), Status::ok);
  rig.peer.send(numbered('A'));
  rig.bus.run_for(milliseconds(1));
  EXPECT_EQ(rig.peer.waiting(), 1U) << "nobody acknowledges";
  ASSERT_EQ(rig.can.change_mode(Mode::normal), Status::ok);
  rig.bus.run_for(milliseconds(1));
  EXPECT_EQ(rig.peer.waiting(), 0U);
  EXPECT_EQ(rig.receive_all(), std::vector{numbered('A')});
}

// It is woken in the middle of the next frame: before change_mode() can look.
TEST(Sleep, OnABusyBusIsShortAndOkAllTheSame) {
  Rig<true> rig;
  rig.begin();
  sim::HostNode witness(rig.bus, 500'000);
  for (std::uint32_t i = 0; i < 100; ++i) {
    rig.peer.send(numbered(i, 8));
  }
  rig.bus.run_for(microseconds(100));
  const sim::SimTime before = rig.bus.now();
  ASSERT_EQ(rig.can.change_mode(Mode::asleep), Status::ok);
  EXPECT_LT(rig.bus.now() - before, milliseconds(1));
  EXPECT_FALSE(rig.can.is_asleep());
  ASSERT_EQ(rig.can.change_mode(Mode::normal), Status::ok);
  rig.bus.run_for(milliseconds(30));
  EXPECT_FALSE(rig.receive_all().empty());
}

TEST(Sleep, EndsHoweverSlowlyTheCrystalStarts) {
  for (const bool by_the_bus : {false, true}) {
    Rig<> rig({.chip = {.crystal_start = milliseconds(10)}});
    rig.bus.run_for(milliseconds(20));
    rig.begin();
    ASSERT_EQ(rig.can.change_mode(Mode::asleep), Status::ok);
    if (by_the_bus) {
      rig.peer.send(numbered('A'));
      rig.bus.run_for(milliseconds(1));
      EXPECT_FALSE(rig.can.is_asleep());
    }
    EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::ok);
    rig.bus.run_for(milliseconds(10));
    rig.receive_all();
    expect_it_works(rig);
  }
}

TEST(Sleep, OfAListenerEndsInAnyMode) {
  Rig<> rig;
  rig.begin(plain_config(Mode::listen_only));
  ASSERT_EQ(rig.can.change_mode(Mode::asleep), Status::ok);
  EXPECT_TRUE(rig.can.is_asleep());
  ASSERT_EQ(rig.can.change_mode(Mode::listen_only), Status::ok);
  EXPECT_EQ(rig.can.send(numbered(1)), Status::wrong_mode);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(rig.can.poll(), Status::ok) << "the mode is the one that is expected";
  }
}

TEST(Sleep, OnABusThatIsStuckEndsWithAWord) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.change_mode(Mode::asleep), Status::ok);
  rig.bus.hold_dominant(true);
  rig.bus.run_for(milliseconds(1));
  EXPECT_EQ(rig.can.change_mode(Mode::normal), Status::wrong_mode);
  EXPECT_EQ(rig.can.counters().chip_losses, 0U) << "the chip is there";
  rig.bus.hold_dominant(false);
  rig.begin();
  expect_it_works(rig);
}

// --- and what shows the buffers ------------------------------------------------------------------

TEST(BufferPins, ShowFullBuffersWhenAsked) {
  Rig<> rig;
  rig.begin();
  const auto pins = [&rig] {
    return std::pair(rig.chip.receive_buffer_pin(0), rig.chip.receive_buffer_pin(1));
  };
  EXPECT_EQ(pins(), std::pair(std::optional<bool>(), std::optional<bool>())) << "not driven";
  rig.can.show_full_buffers(true);
  EXPECT_EQ(rig.chip.peek(0x0C), 0x0F);
  EXPECT_EQ(pins(), std::pair(std::optional(true), std::optional(true)));
  rig.peer_sends({numbered(1), numbered(2)});
  EXPECT_EQ(pins(), std::pair(std::optional(false), std::optional(false))) << "low while full";
  Frame frame{};
  ASSERT_EQ(rig.can.receive(frame), Status::ok);
  EXPECT_EQ(pins(), std::pair(std::optional(true), std::optional(false)));
  rig.can.show_full_buffers(false);
  EXPECT_EQ(pins(), std::pair(std::optional<bool>(), std::optional<bool>()));
}

}  // namespace
}  // namespace roio::test
