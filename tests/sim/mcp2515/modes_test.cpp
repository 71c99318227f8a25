// Power, oscillator start-up and modes of operation (datasheet, sections 8 to 10); sleep is
// sleep_test.cpp's.
#include <memory>

#include "chip_rig.hpp"

namespace roio::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

// --- oscillator start-up timer (8.1) -------------------------------------------------------------

TEST(Mcp2515Power, TheOscillatorTakes128ClocksToStartUp) {
  struct Row {
    const char* why;
    std::uint32_t osc_hz;
    sim::SimTime crystal_start;
    sim::SimTime start_up;
  };
  const Row rows[] = {
      {"16 MHz", 16'000'000, microseconds(0), microseconds(8)},
      {"8 MHz: twice as long", 8'000'000, microseconds(0), microseconds(16)},
      {"and the crystal has to swing first", 16'000'000, milliseconds(2), microseconds(2008)},
  };
  for (const Row& row : rows) {
    for (const bool early : {true, false}) {
      sim::CanBus bus;
      sim::Mcp2515Chip chip(bus, {.osc_hz = row.osc_hz, .crystal_start = row.crystal_start});
      bus.run_for(row.start_up - sim::SimTime(early ? 1 : 0));
      chip.select();
      chip.exchange(0x03);
      chip.exchange(0x0F);
      EXPECT_EQ(chip.exchange(0x00), early ? 0x00 : 0x87) << row.why;
      chip.deselect();
      EXPECT_EQ(chip.violations().size(), early ? 3U : 0U) << row.why << ": lost and noted";
    }
  }
}

TEST(Mcp2515Power, AResetStartsTheTimerButNotTheCrystal) {
  for (const bool by_pin : {true, false}) {
    ChipRig rig({.crystal_start = milliseconds(5)});
    rig.bus.run_for(milliseconds(10));
    if (by_pin) {
      rig.chip.reset_pin();
    } else {
      rig.spi({0xC0});
    }
    rig.bus.run_for(microseconds(7));
    rig.write(0x2B, 0xFF);
    EXPECT_EQ(rig.violations().size(), 3U) << "too early";
    rig.bus.run_for(microseconds(1));
    EXPECT_EQ(rig.read(0x2B), 0x00) << "the write was lost";
    rig.write(0x2B, 0xFF);
    EXPECT_EQ(rig.read(0x2B), 0xFF);
    EXPECT_EQ(rig.violations().size(), 3U);
  }
}

TEST(Mcp2515Power, AnotherResetStartsTheTimerAnew) {
  ChipRig rig;
  rig.chip.reset_pin();
  rig.bus.run_for(microseconds(4));
  rig.chip.reset_pin();
  rig.bus.run_for(microseconds(7));
  EXPECT_EQ(rig.read(0x0F), 0x00);
  rig.bus.run_for(microseconds(1));
  EXPECT_EQ(rig.read(0x0F), 0x87);
}

TEST(Mcp2515Power, AResetEndsWhatIsUnderWay) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(20);
  rig.spi({0xC0});
  rig.run_bits(300);
  EXPECT_EQ(rig.read(0x30), 0x00);
  EXPECT_EQ(rig.read(0x0E), 0x80);
  EXPECT_EQ(rig.on_bus, Texts{}) << "half a frame";
  rig.go();
  rig.request_to_send(1);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"}) << "the buffer still holds it";
}

TEST(Mcp2515Power, AChipMayEndBeforeItsBusDoes) {
  sim::CanBus bus;
  auto chip = std::make_unique<sim::Mcp2515Chip>(bus);
  chip.reset();
  bus.run_for(milliseconds(1));
  EXPECT_EQ(bus.now(), milliseconds(1)) << "nothing of it is left in the bus";
}

// --- changing modes (10) -------------------------------------------------------------------------

TEST(Mcp2515Modes, CanstatShowsTheModeThatWasAskedFor) {
  for (const std::uint8_t from : Bytes{0x00, 0x40, 0x60, 0x80}) {
    for (const std::uint8_t to : Bytes{0x00, 0x20, 0x40, 0x60, 0x80}) {
      ChipRig rig;
      rig.go(from);
      rig.write(0x0F, to);
      rig.run_bits(12);
      EXPECT_EQ(rig.read(0x0E), to) << "from " << int{from};
      EXPECT_EQ(rig.read(0x0F), to);
      EXPECT_EQ(rig.violations(), Texts{});
    }
  }
}

TEST(Mcp2515Modes, ThreeRequestsAreNone) {
  for (const std::uint8_t request : Bytes{0xA0, 0xC0, 0xE0}) {
    ChipRig rig;
    rig.go();
    rig.write(0x0F, request);
    rig.run_bits(20);
    EXPECT_EQ(rig.read(0x0E), 0x00);
    EXPECT_EQ(rig.violations().size(), 1U);
    rig.write(0x0F, 0x60);
    rig.run_bits(12);
    EXPECT_EQ(rig.read(0x0E), 0x60) << "it recovers from that";
  }
}

TEST(Mcp2515Modes, OtherBitsOfCanctrlDoNotTouchTheMode) {
  ChipRig rig;
  rig.go();
  rig.peer.send({0x123, FrameKind::standard, 0, {}});
  rig.run_bits(20);
  rig.write(0x0F, 0x0F);
  rig.run_bits(60);
  EXPECT_EQ(rig.read(0x2C), 0x01) << "reception goes on";
}

TEST(Mcp2515Modes, NormalAndListenOnlyBeginAfterElevenRecessiveBits) {
  for (const std::uint8_t mode : Bytes{0x00, 0x60}) {
    ChipRig rig;
    rig.set_bit_timing();
    rig.bus.hold_dominant(true);
    rig.write(0x0F, mode);
    rig.run_bits(1'000);
    EXPECT_EQ(rig.read(0x0E), 0x80) << "a bus held down is never entered";
    rig.bus.hold_dominant(false);
    rig.run_bits(10);
    EXPECT_EQ(rig.read(0x0E), 0x80);
    rig.run_bits(2);
    EXPECT_EQ(rig.read(0x0E), mode);
  }
}

TEST(Mcp2515Modes, AChangeMayBeTakenBackWhileItWaits) {
  ChipRig rig;
  rig.set_bit_timing();
  rig.write(0x0F, 0x00);
  rig.run_bits(5);
  rig.write(0x0F, 0x80);
  rig.run_bits(20);
  EXPECT_EQ(rig.read(0x0E), 0x80);
  rig.write(0x28, 0x03);
  EXPECT_EQ(rig.violations(), Texts{}) << "configuration mode all the time";
}

TEST(Mcp2515Modes, AChangeWaitsForPendingMessages) {
  for (const std::uint8_t mode : Bytes{0x20, 0x40, 0x60, 0x80}) {
    ChipRig rig;
    rig.go();
    rig.load_standard(0, 0x100);
    rig.load_standard(1, 0x101);
    rig.request_to_send(3);
    rig.run_bits(20);
    rig.write(0x0F, mode);
    EXPECT_EQ(rig.read(0x0E), 0x00) << "the old mode, until then";
    rig.run_bits(60);
    EXPECT_EQ(rig.on_bus.size(), 1U);
    EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x00);
    rig.run_bits(100);
    EXPECT_EQ(rig.on_bus.size(), 2U) << "all of them are sent";
    EXPECT_EQ(rig.read(0x0E) & 0xE0, mode);
  }
}

TEST(Mcp2515Modes, AMessageThatNobodyAcknowledgesHoldsTheChangeUp) {
  struct Row {
    const char* why;
    std::uint8_t address;
    std::uint8_t mask;
    std::uint8_t value;
  };
  constexpr Row rows[] = {{"until it is taken back", 0x30, 0x08, 0x00},
                          {"until all are", 0x0F, 0x10, 0x10},
                          {"until it is the last attempt", 0x0F, 0x08, 0x08}};
  for (const Row& row : rows) {
    ChipRig rig;
    rig.silence_peer();
    rig.go();
    rig.load_standard(0, 0x123);
    rig.request_to_send(1);
    rig.write(0x0F, 0x80);
    rig.bus.run_for(milliseconds(10));
    EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x00) << row.why;
    rig.modify(row.address, row.mask, row.value);
    rig.run_bits(100);
    EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x80) << row.why;
  }
}

TEST(Mcp2515Modes, AWaitingMessageTakenBackFreesTheChangeAtOnce) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x123);
  rig.peer.send({0x100, FrameKind::standard, 8, {}});
  rig.run_bits(20);
  rig.request_to_send(1);
  rig.write(0x0F, 0x80);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x00);
  rig.write(0x30, 0x00);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x80);
}

TEST(Mcp2515Modes, AMessageTakenBackThatLosesArbitrationFreesTheChange) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x7FF);
  rig.peer.send({0x7FE, FrameKind::standard, 8, {}});
  rig.request_to_send(1);
  rig.run_bits(5);
  rig.write(0x30, 0x00);
  rig.write(0x0F, 0x80);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x00) << "it is still on the wire";
  rig.run_bits(25);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x80);
}

TEST(Mcp2515Modes, InConfigurationModeTheChipIsNoPartOfTheBus) {
  ChipRig rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.write(0x28, Bytes{0x02, 0xB4, 0x01});  // 250 kbit/s
  rig.write(0x0F, 0x60);
  rig.run_bits(50);
  rig.write(0x0F, 0x80);
  ASSERT_EQ(rig.read(0x0E), 0x80);
  for (unsigned errors = 1; errors <= 10; ++errors) {
    rig.peer.send({0x123, FrameKind::standard, 8, {}});
    rig.run_bits(30 + errors);
    rig.bus.flip_next_bit();
    rig.run_bits(300);
    ASSERT_EQ(rig.peer.waiting(), 0U);
    EXPECT_EQ(rig.bus.statistics().transmit_errors, errors) << "the fault hits those who are";
  }
  EXPECT_EQ(rig.read(0x2C), 0x00);
}

// --- loopback mode (10.4) ------------------------------------------------------------------------

TEST(Mcp2515Modes, LoopbackTakesTheFrameAroundWithoutABus) {
  ChipRig rig;
  rig.bus.hold_dominant(true);
  rig.set_bit_timing();
  rig.write(0x60, 0x60);
  rig.write(0x0F, 0x40);
  EXPECT_EQ(rig.read(0x0E), 0x40) << "at once: it does not look at the wire";
  rig.load(0, {0xD5, 0xE8, 0xDE, 0x12, 0x02, 0x11, 0x22});
  rig.request_to_send(1);
  rig.run_bits(70);
  EXPECT_EQ(rig.read(0x2C), 0x00) << "it takes as long as on a bus";
  EXPECT_EQ(rig.read(0x30), 0x08);
  rig.run_bits(40);
  EXPECT_EQ(rig.read(0x2C), 0x05);
  EXPECT_EQ(rig.read(0x30), 0x00);
  EXPECT_EQ(rig.read(0x61, 7), (Bytes{0xD5, 0xE8, 0xDE, 0x12, 0x02, 0x11, 0x22}));
  EXPECT_EQ(rig.read(0x1C), 0);
  EXPECT_EQ(rig.bus.statistics().frames, 0U);
}

TEST(Mcp2515Modes, LoopbackKeepsPrioritiesAndFilters) {
  ChipRig rig;
  rig.write(0x20, Bytes{0xFF, 0xE0, 0x00, 0x00, 0xFF, 0xE0, 0x00, 0x00});
  rig.write(0x00, Bytes{0x20, 0x00, 0x00, 0x00, 0x20, 0x20, 0x00, 0x00, 0x20, 0x40, 0x00, 0x00});
  rig.go(0x40, 0x00, 0x00);
  for (std::uint8_t buffer = 0; buffer < 3; ++buffer) {
    rig.load_standard(buffer, 0x100U + 2 * buffer, buffer);  // 104h passes no filter
  }
  std::vector<std::string> sent;
  rig.chip.on_sent([&](const Frame& frame) { sent.push_back(text_of(frame)); });
  rig.request_to_send(7);
  rig.run_bits(300);
  EXPECT_EQ(sent, (Texts{"104 DLC 1 02", "102 DLC 1 01", "100 DLC 1 00"}));
  EXPECT_EQ(rig.read(0x2C), 0x1F);
  EXPECT_EQ(rig.read(0x66), 0);
  EXPECT_EQ(rig.read(0x76), 1);
  EXPECT_EQ(rig.on_bus, Texts{});
}

TEST(Mcp2515Modes, LoopbackTakesWhatWasRequestedBefore) {
  ChipRig rig;
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.go(0x40);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x2C), 0x05);
}

TEST(Mcp2515Modes, LoopbackIsNotLeftInTheMiddleOfAFrame) {
  ChipRig rig;
  rig.go(0x40);
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(20);
  rig.write(0x30, 0x00);
  rig.write(0x0F, 0x80);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x40);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x2C), 0x05);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x80);
  rig.go(0x40);
  rig.write(0x2C, 0x00);
  rig.request_to_send(1);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x2C), 0x05) << "and it works again";
}

TEST(Mcp2515Modes, WhatIsRequestedOnTheWayOutOfLoopbackGoesToTheBus) {
  ChipRig rig;
  rig.go(0x40);
  rig.load_standard(0, 0x123);
  rig.write(0x0F, 0x00);
  rig.run_bits(5);
  ASSERT_EQ(rig.read(0x0E) & 0xE0, 0x40) << "eleven recessive bits have not passed";
  rig.request_to_send(1);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
  EXPECT_EQ(rig.read(0x2C), 0x04) << "sent, and not received by itself";
}

TEST(Mcp2515Modes, AResetEndsALoopbackUnderWay) {
  ChipRig rig;
  rig.go(0x40);
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(20);
  rig.chip.reset_pin();
  rig.run_bits(20);
  rig.go(0x40);
  rig.run_bits(60);
  EXPECT_EQ(rig.read(0x2C), 0x00) << "it does not come any more";
  rig.request_to_send(1);
  rig.run_bits(100);
  EXPECT_EQ(rig.read(0x2C), 0x05);
}

TEST(Mcp2515Modes, LoopbackDoesNotHearTheBus) {
  ChipRig rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.go(0x40);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x00);
}

}  // namespace
}  // namespace roio::test
