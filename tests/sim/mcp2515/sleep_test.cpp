// Sleep mode (datasheet, section 10.2).
#include "chip_rig.hpp"

namespace roio::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(Mcp2515Modes, AsleepItHearsNoFrameButItsRegistersCanBeRead) {
  ChipRig rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.go();
  rig.write(0x0F, 0x20);
  EXPECT_EQ(rig.read(0x0E), 0x20);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x00);
  EXPECT_EQ(rig.read(0x0E), 0x20) << "WAKIE is clear: it sleeps on";
  EXPECT_EQ(rig.read(0x28, 3), (Bytes{0x02, 0xB4, 0x00}));
  EXPECT_EQ(rig.violations(), Texts{});
}

TEST(Mcp2515Modes, ABusThatStirsWakesIt) {
  ChipRig rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.write(0x2B, 0x40);
  rig.go();
  rig.write(0x0F, 0x27);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x0E), 0x20);
  rig.peer.send({0x123, FrameKind::standard, 0, {}});
  rig.run_bits(2);
  EXPECT_EQ(rig.chip.peek(0x2C), 0x40);
  EXPECT_FALSE(rig.chip.interrupt_pin()) << "at once";
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x2C), 0x40) << "the message that woke it is lost";
  EXPECT_EQ(rig.read(0x0E), 0x64) << "listen-only, ICOD wake-up";
  EXPECT_EQ(rig.read(0x0F), 0x67);
  rig.peer_sends({0x124, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x41) << "the next is heard";
  rig.write(0x0F, 0x00);
  rig.run_bits(12);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x00);
  EXPECT_EQ(rig.violations(), Texts{});
}

TEST(Mcp2515Modes, SoftwareWakesItBySettingWakif) {
  struct Row {
    const char* why;
    Bytes caninte_and_canintf;
    bool wakes;
  };
  const Row rows[] = {{"both", {0x40, 0x40}, true},
                      {"not without WAKIE", {0x00, 0x40}, false},
                      {"not without WAKIF", {0x40, 0x00}, false},
                      {"no other flag", {0xBF, 0xBF}, false}};
  for (const Row& row : rows) {
    ChipRig rig;
    rig.go(0x20);
    rig.write(0x2B, row.caninte_and_canintf);
    rig.bus.run_for(microseconds(7));
    EXPECT_EQ(rig.chip.peek(0x0E) & 0xE0, 0x20) << row.why << ": the oscillator starts up first";
    rig.bus.run_for(microseconds(1));
    EXPECT_EQ(rig.read(0x0E) & 0xE0, row.wakes ? 0x60 : 0x20) << row.why;
    EXPECT_EQ(rig.violations(), Texts{}) << row.why;
  }
}

TEST(Mcp2515Modes, WakingTakesTheCrystalsTimeAndSpiMustWait) {
  ChipRig rig({.crystal_start = microseconds(500)});
  rig.go(0x20);
  rig.write(0x2B, Bytes{0x40, 0x40});
  rig.bus.run_for(microseconds(507));
  EXPECT_EQ(rig.read(0x0E), 0x00) << "lost";
  EXPECT_EQ(rig.violations().size(), 3U);
  rig.bus.run_for(microseconds(1));
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x60);
  EXPECT_EQ(rig.violations().size(), 3U);
}

TEST(Mcp2515Modes, AsleepItTakesNoRequestForAnotherMode) {
  ChipRig rig;
  rig.go(0x20);
  rig.write(0x0F, 0x20);
  EXPECT_EQ(rig.violations(), Texts{});
  rig.write(0x0F, 0x00);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x0E), 0x20);
  EXPECT_EQ(rig.violations().size(), 1U);
  rig.request_to_send(1);
  rig.write(0x30, 0x00);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x0E), 0x20)
      << "nor is the old request remembered when a buffer is taken back";
}

TEST(Mcp2515Modes, WhatIsRequestedAsleepIsSentWhenItIsNormalAgain) {
  ChipRig rig;
  rig.go(0x20);
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.write(0x2B, Bytes{0x40, 0x40});
  rig.run_bits(100);
  EXPECT_EQ(rig.on_bus, Texts{});
  rig.write(0x0F, 0x00);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
}

TEST(Mcp2515Modes, ResetEndsSleep) {
  ChipRig rig;
  rig.go(0x20);
  rig.spi({0xC0});
  rig.run_bits(10);
  EXPECT_EQ(rig.read(0x0E), 0x80);
  EXPECT_EQ(rig.violations(), Texts{});
}

}  // namespace
}  // namespace roio::test
