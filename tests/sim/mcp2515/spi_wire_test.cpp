// The SPI between a microcontroller and the chip: what it takes, and its faults.
#include <roio/sim/spi_wire.hpp>

#include "chip_rig.hpp"

namespace roio::test {
namespace {

using sim::SpiWire;
using std::chrono::microseconds;

struct WireRig : ChipRig {
  explicit WireRig(const SpiWire::Timing& timing = {}) : wire(bus, chip, timing) {}

  Bytes transfer(const Bytes& out) {
    wire.select();
    Bytes in;
    for (const std::uint8_t byte : out) {
      in.push_back(wire.exchange(byte));
    }
    wire.deselect();
    return in;
  }

  SpiWire wire;
};

TEST(SpiWire, CarriesBothWaysAndCounts) {
  WireRig rig;
  EXPECT_EQ(rig.transfer({0x02, 0x2B, 0x1F}), Bytes(3));
  EXPECT_EQ(rig.transfer({0x03, 0x2B, 0x00}), (Bytes{0x00, 0x00, 0x1F}));
  rig.transfer({});
  EXPECT_EQ(rig.wire.bytes(), 6U);
  EXPECT_EQ(rig.wire.transactions(), 2U) << "those with a byte in them";
}

TEST(SpiWire, TakesItsTime) {
  WireRig rig({.byte = microseconds(3), .select = microseconds(2)});
  const sim::SimTime start = rig.bus.now();
  rig.transfer({0x03, 0x2B, 0x00});
  EXPECT_EQ(rig.bus.now() - start, microseconds(2 + 3 * 3 + 2));
  EXPECT_EQ(rig.wire.now(), rig.bus.now());
  WireRig plain;
  const sim::SimTime before = plain.bus.now();
  plain.transfer({0x03, 0x2B, 0x00});
  EXPECT_EQ(plain.bus.now() - before, microseconds(3)) << "8 MHz";
}

TEST(SpiWire, AByteCountsAtItsEnd) {
  WireRig rig({.byte = microseconds(100)});
  rig.go();
  rig.wire.select();
  rig.wire.exchange(0xA0);
  rig.peer.send({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.wire.exchange(0x00), 0x01) << "the frame came in meanwhile";
  rig.wire.deselect();
}

TEST(SpiWire, StepsAreToldBeforeBytesAndEdges) {
  WireRig rig;
  std::vector<std::uint64_t> bytes_before;
  rig.wire.on_step([&] { bytes_before.push_back(rig.wire.bytes()); });
  rig.transfer({0xA0, 0x00});
  EXPECT_EQ(bytes_before, (std::vector<std::uint64_t>{0, 0, 1, 2}));
}

TEST(SpiWire, UnpluggedItReadsOneLevelAndReachesNothing) {
  struct Row {
    SpiWire::Fault fault;
    std::uint8_t level;
  };
  constexpr Row rows[] = {{SpiWire::Fault::stuck_low, 0x00}, {SpiWire::Fault::stuck_high, 0xFF}};
  for (const Row& row : rows) {
    WireRig rig;
    rig.write(0x2B, Bytes{0x01, 0x01});
    EXPECT_TRUE(rig.wire.interrupt_line_is_low());
    rig.wire.set_fault(row.fault);
    EXPECT_EQ(rig.transfer({0x03, 0x0F, 0x00}), Bytes(3, row.level));
    rig.transfer({0x02, 0x2B, 0x1F});
    EXPECT_EQ(rig.chip.peek(0x2B), 0x01);
    EXPECT_FALSE(rig.wire.interrupt_line_is_low());
    rig.wire.set_fault(SpiWire::Fault::none);
    EXPECT_EQ(rig.transfer({0x03, 0x2B, 0x00}).back(), 0x01);
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(SpiWire, UnpluggedInTheMiddleTheRestIsLost) {
  WireRig rig;
  rig.wire.select();
  for (const std::uint8_t byte : Bytes{0x02, 0x28, 0x02}) {
    rig.wire.exchange(byte);
  }
  rig.wire.set_fault(SpiWire::Fault::stuck_high);
  EXPECT_EQ(rig.wire.exchange(0xB4), 0xFF);
  rig.wire.deselect();
  EXPECT_EQ(rig.chip.peek(0x28), 0x02);
  EXPECT_EQ(rig.chip.peek(0x29), 0x00);
}

TEST(SpiWire, ForTheChipUnpluggingRaisesChipSelect) {
  WireRig rig;
  rig.wire.select();
  rig.wire.exchange(0x81);
  EXPECT_EQ(rig.chip.peek(0x30), 0x00);
  rig.wire.set_fault(SpiWire::Fault::stuck_high);
  EXPECT_EQ(rig.chip.peek(0x30), 0x08);
  rig.wire.deselect();
}

TEST(SpiWire, PluggedInInTheMiddleTheChipHearsTheRest) {
  WireRig rig;
  rig.wire.set_fault(SpiWire::Fault::stuck_low);
  rig.wire.select();
  EXPECT_EQ(rig.wire.exchange(0x02), 0x00);
  rig.wire.set_fault(SpiWire::Fault::none);
  for (const std::uint8_t byte : Bytes{0x03, 0x0F}) {
    rig.wire.exchange(byte);
  }
  EXPECT_EQ(rig.wire.exchange(0x00), 0x87) << "taken for an instruction";
  rig.wire.deselect();
}

TEST(SpiWire, TheInterruptLineMaySpike) {
  WireRig rig;
  EXPECT_FALSE(rig.wire.interrupt_line_is_low());
  rig.wire.spike_on_interrupt_line();
  EXPECT_TRUE(rig.wire.interrupt_line_is_low());
  EXPECT_FALSE(rig.wire.interrupt_line_is_low()) << "for one look";
}

TEST(SpiWire, TheInterruptLineMayBeStuckOrCut) {
  WireRig rig;
  const auto pull = [&rig](bool pulls) {
    rig.transfer({0x02, 0x2B, 0x01, static_cast<std::uint8_t>(pulls ? 0x01 : 0x00)});
  };
  rig.wire.hold_interrupt_line_low(true);
  EXPECT_TRUE(rig.wire.interrupt_line_is_low());
  rig.wire.hold_interrupt_line_low(false);
  EXPECT_FALSE(rig.wire.interrupt_line_is_low());
  pull(true);
  EXPECT_TRUE(rig.wire.interrupt_line_is_low());
  rig.wire.cut_interrupt_line(true);
  EXPECT_FALSE(rig.wire.interrupt_line_is_low()) << "pulled up";
  rig.wire.cut_interrupt_line(false);
  EXPECT_TRUE(rig.wire.interrupt_line_is_low());
  rig.wire.cut_interrupt_line(true);
  rig.wire.clear_faults();
  EXPECT_TRUE(rig.wire.interrupt_line_is_low());
  pull(false);
  EXPECT_FALSE(rig.wire.interrupt_line_is_low());
}

TEST(SpiWire, FaultsCanBeCleared) {
  WireRig rig;
  rig.wire.set_fault(SpiWire::Fault::stuck_high);
  rig.wire.set_bit_flips(1, 1);
  rig.wire.lose_select_after(1);
  rig.wire.spike_on_interrupt_line();
  rig.wire.clear_faults();
  EXPECT_FALSE(rig.wire.interrupt_line_is_low());
  EXPECT_EQ(rig.transfer({0x03, 0x0F, 0x00}), (Bytes{0x00, 0x00, 0x87}));
}

TEST(SpiWire, LosesSelectOnceWhereItWasTold) {
  struct Row {
    std::uint32_t after;
    int cnf3;
    int cnf2;
    int cnf1;
    std::size_t noted;  // bytes taken for an instruction that are none
  };
  constexpr Row rows[] = {
      {0, 0x07, 0x35, 0x06, 0},  // before the first byte: no harm
      {2, 0x00, 0x00, 0x00, 1}, {3, 0x07, 0x00, 0x00, 1},
      {4, 0x07, 0x35, 0x00, 1}, {5, 0x07, 0x35, 0x06, 0},  // hits the next transaction
  };
  for (const Row& row : rows) {
    WireRig rig;
    rig.wire.lose_select_after(row.after);
    rig.transfer({0x02, 0x28, 0x07, 0x35, 0x06});
    EXPECT_EQ(rig.chip.peek(0x28), row.cnf3) << row.after;
    EXPECT_EQ(rig.chip.peek(0x29), row.cnf2) << row.after;
    EXPECT_EQ(rig.chip.peek(0x2A), row.cnf1) << row.after;
    EXPECT_EQ(rig.violations().size(), row.noted) << row.after;
    rig.transfer({0x02, 0x2B, 0x1F});
    rig.transfer({0x02, 0x2B, 0x1E});
    EXPECT_EQ(rig.chip.peek(0x2B), 0x1E) << "once only";
  }
}

TEST(SpiWire, FlipsBitsAsOftenAsToldAndTheSameFromASeed) {
  const auto flips = [](double probability, std::uint32_t seed) {
    WireRig rig;
    rig.wire.set_bit_flips(probability, seed);
    rig.wire.select();
    int count = 0;
    for (int i = 0; i < 2'000; ++i) {
      // Unselected the chip would send FF; an instruction of 00 makes it send 00.
      count += __builtin_popcount(rig.wire.exchange(0x00));
    }
    rig.wire.deselect();
    return count;
  };
  EXPECT_EQ(flips(0, 1), 0);
  EXPECT_EQ(flips(1, 1), 16'000);
  const int some = flips(0.01, 1);
  EXPECT_GT(some, 80);
  EXPECT_LT(some, 320);
  EXPECT_EQ(flips(0.01, 1), some);
  EXPECT_NE(flips(0.01, 2), some);
}

TEST(SpiWire, FlipsHitWhatTheChipHearsAsWell) {
  WireRig rig;
  rig.wire.set_bit_flips(1, 1);
  rig.transfer({0xFD, 0xD4, 0xE0});  // 02 2B 1F
  EXPECT_EQ(rig.chip.peek(0x2B), 0x1F);
}

TEST(SpiWire, ThePortIsTheDriversViewOfIt) {
  WireRig rig;
  sim::ChipPort<true> port(rig.wire);
  {
    sim::ChipPort<true>::Transaction transaction(port, 0x02);
    EXPECT_TRUE(rig.wire.selected());
    transaction.put(0x2B);
    transaction.put(0x1F);
    transaction.release();
    EXPECT_FALSE(rig.wire.selected());
    transaction.restart(0x03);
    transaction.put(0x2B);
    EXPECT_EQ(transaction.exchange(0x00), 0x1F);
  }
  EXPECT_FALSE(rig.wire.selected());
  EXPECT_FALSE(port.interrupt_line_is_low());
  rig.write(0x2C, 0x01);
  EXPECT_TRUE(port.interrupt_line_is_low());
  const std::uint32_t then = port.microseconds();
  rig.wire.pass(microseconds(10));
  EXPECT_EQ(port.microseconds() - then, 11U) << "a look at the clock takes one itself";
}

}  // namespace
}  // namespace roio::test
