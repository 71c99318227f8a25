// Bit timing: what CNF1..3 make of the oscillator, and what a node at another rate does to a bus
// (datasheet, section 5).
#include "chip_rig.hpp"

namespace roio::test {
namespace {

struct Row {
  const char* why;
  std::uint32_t osc_hz;
  std::uint8_t cnf1;
  std::uint8_t cnf2;
  std::uint8_t cnf3;
  std::uint32_t bitrate_bps;  // 0: against the rules
};

constexpr Row rows[] = {
    {"16 quanta of 125 ns", 16'000'000, 0x00, 0xF0, 0x86, 500'000},
    {"8 quanta of 125 ns", 16'000'000, 0x00, 0xD0, 0x82, 1'000'000},
    {"8 quanta of 250 ns", 8'000'000, 0x00, 0x90, 0x82, 500'000},
    {"16 quanta of 500 ns", 16'000'000, 0x03, 0xF0, 0x86, 125'000},
    {"20 quanta of 2 us", 20'000'000, 0x13, 0xBE, 0x03, 25'000},
    {"the longest quantum: 64 times two clocks", 16'000'000, 0x3F, 0xF0, 0x86, 7'812},
    {"the shortest bit: 5 quanta", 20'000'000, 0x01, 0x80, 0x01, 1'000'000},
    {"the longest bit: 25 quanta", 20'000'000, 0x00, 0xBF, 0x07, 400'000},
    {"PS2 of one quantum: shorter than the information processing time", 8'000'000, 0x00, 0x80,
     0x80, 0},
    {"PS2 of two", 8'000'000, 0x00, 0x80, 0x81, 800'000},
    {"PropSeg + PS1 = PS2", 16'000'000, 0x00, 0x91, 0x04, 727'272},
    {"PropSeg + PS1 = PS2 - 1", 16'000'000, 0x00, 0x91, 0x05, 0},
    {"PS2 one above SJW", 16'000'000, 0x80, 0xB4, 0x03, 470'588},
    {"PS2 equal to SJW", 16'000'000, 0xC0, 0xB4, 0x03, 0},
    {"PS2 below SJW", 16'000'000, 0xC0, 0xB4, 0x02, 0},
    {"BTLMODE 0: PS2 is PS1, whatever CNF3 says", 16'000'000, 0x00, 0x10, 0x07, 1'000'000},
    {"BTLMODE 0 and PS1 of one: PS2 is two", 16'000'000, 0x00, 0x00, 0x00, 1'600'000},
    {"SAM, SOF and WAKFIL do not change the rate", 16'000'000, 0x00, 0xF4, 0xC2, 500'000},
};

TEST(Mcp2515BitTiming, FollowsFromOscillatorAndRegisters) {
  for (const Row& row : rows) {
    ChipRig rig({.osc_hz = row.osc_hz});
    rig.write(0x28, Bytes{row.cnf3, row.cnf2, row.cnf1});
    EXPECT_EQ(rig.chip.bitrate_bps(), row.bitrate_bps) << row.why;
    EXPECT_EQ(rig.violations(), Texts{}) << row.why << ": not in use yet";
    rig.write(0x0F, 0x00);
    EXPECT_EQ(rig.violations().size(), row.bitrate_bps == 0 ? 1U : 0U) << row.why;
  }
}

TEST(Mcp2515BitTiming, TheWireRunsAtThatRate) {
  for (const Row& row : rows) {
    if (row.bitrate_bps < 10'000) {
      continue;
    }
    ChipRig rig({.osc_hz = row.osc_hz});
    sim::HostNode other(rig.bus, row.bitrate_bps);
    rig.silence_peer();
    std::vector<Frame> received;
    other.on_receive([&](const Frame& frame) { received.push_back(frame); });
    rig.write(0x28, Bytes{row.cnf3, row.cnf2, row.cnf1});
    rig.write(0x0F, 0x00);
    rig.load_standard(0, 0x123);
    rig.request_to_send(1);
    rig.bus.run_for(std::chrono::milliseconds(10));
    EXPECT_EQ(text_of(received), Texts{"123 DLC 1 5A"}) << row.why;
    EXPECT_EQ(rig.bus.statistics().transmit_errors, 0U) << row.why;
  }
}

struct Strangers : ChipRig {
  explicit Strangers(std::uint8_t canctrl) {
    peer.on_receive([](const Frame&) {});
    write(0x28, Bytes{0x02, 0xB4, 0x01});  // 250 kbit/s on a bus of 500
    write(0x60, 0x60);
    write(0x0F, canctrl);
    run_bits(100);
    peer.send(
        {0x1ABCDE12, FrameKind::extended, 8, {0x55, 0x33, 0x0F, 0xA5, 0x00, 0xFF, 0x69, 0x96}});
    run_bits(400);
  }
  sim::HostNode witness{bus, rate};
};

TEST(Mcp2515BitTiming, ANodeAtAnotherRateDisturbsTheBus) {
  Strangers rig(0x00);
  EXPECT_GT(rig.bus.statistics().transmit_errors, 0U);
  EXPECT_GT(rig.read(0x1D), 0);
  EXPECT_EQ(rig.read(0x2C) & 0x81, 0x80) << "an error, and no message";
}

TEST(Mcp2515BitTiming, AListenerAtAnotherRateOnlyNoticesIt) {
  Strangers rig(0x60);
  EXPECT_EQ(rig.bus.statistics().transmit_errors, 0U);
  EXPECT_EQ(rig.peer.waiting(), 0U);
  EXPECT_EQ(rig.read(0x1D), 0) << "counters stand still in listen-only mode";
  EXPECT_EQ(rig.read(0x2C) & 0x81, 0x80) << "MERRF is what detecting the rate goes by";
}

}  // namespace
}  // namespace roio::test
