// Listen-only mode (datasheet, section 10.3).
#include "chip_rig.hpp"

namespace roio::test {
namespace {

TEST(Mcp2515Modes, ListenOnlyReceivesAndDrivesNothing) {
  ChipRig rig;
  rig.go(0x60);
  rig.peer.send({0x123, FrameKind::standard, 1, {0x42}});
  rig.run_bits(500);
  EXPECT_EQ(rig.peer.waiting(), 1U) << "nobody acknowledges";
  EXPECT_EQ(rig.read(0x1D), 0);
  EXPECT_EQ(rig.read(0x2C), 0x80) << "errors are seen: MERRF";
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.run_bits(500);
  EXPECT_EQ(rig.peer.waiting(), 0U);
  EXPECT_EQ(rig.read(0x2C), 0x81);
  EXPECT_EQ(rig.read(0x66), 0x42);
}

TEST(Mcp2515Modes, ListenOnlyOverwritesNoBuffer) {
  ChipRig rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.go(0x60);
  rig.peer_sends({0x123, FrameKind::standard, 1, {1}});
  rig.peer_sends({0x123, FrameKind::standard, 1, {2}});
  EXPECT_EQ(rig.read(0x66), 1);
  EXPECT_EQ(rig.read(0x2D), 0x40);
}

/// Both masks compare every bit, and all six filters want the standard identifier 7FF with data
/// FF FF.
void filter_all_but_7ff(ChipRig& rig) {
  rig.write(0x20, Bytes{0xFF, 0xE3, 0xFF, 0xFF, 0xFF, 0xE3, 0xFF, 0xFF});
  for (const std::uint8_t filter : Bytes{0x00, 0x04, 0x08, 0x10, 0x14, 0x18}) {
    rig.write(filter, Bytes{0xFF, 0xE0, 0xFF, 0xFF});
  }
}

const std::vector<Frame> frames_that_filters_refuse{
    {0x123, FrameKind::standard, 2, {0x01, 0x02}},
    {0x1000400A, FrameKind::extended, 1, {0x42}},
};

TEST(Mcp2515Modes, ListenOnlyReceivesEverythingWhateverFiltersAndRxmSay) {
  for (const std::uint8_t rxm : Bytes{0x00, 0x20, 0x40, 0x60}) {
    for (const Frame& frame : frames_that_filters_refuse) {
      ChipRig rig;
      sim::HostNode witness(rig.bus, ChipRig::rate);
      filter_all_but_7ff(rig);
      rig.go(0x60, rxm, rxm);
      rig.peer_sends(frame);
      EXPECT_EQ(rig.read(0x2C), 0x01) << "RXB0 has it; RXM " << int{rxm};
      EXPECT_EQ(rig.read(0x60) & 1, 0) << "FILHIT";
    }
  }
}

TEST(Mcp2515Modes, ListenOnlyRollsOverAsEver) {
  ChipRig rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  filter_all_but_7ff(rig);
  rig.go(0x60, 0x04, 0x00);
  rig.peer_sends(frames_that_filters_refuse[0]);
  rig.peer_sends(frames_that_filters_refuse[1]);
  EXPECT_EQ(rig.read(0x2C), 0x03);
  rig.write(0x0F, 0x00);
  rig.run_bits(12);
  rig.write(0x2C, 0x00);
  rig.peer_sends(frames_that_filters_refuse[0]);
  EXPECT_EQ(rig.read(0x2C), 0x00) << "in normal mode filters hold again";
}

TEST(Mcp2515Modes, FiltersHoldInListenOnlyAsInOlderDatasheetsWhenAsked) {
  for (const Frame& frame : frames_that_filters_refuse) {
    ChipRig rig({.listen_only_filters = true});
    sim::HostNode witness(rig.bus, ChipRig::rate);
    filter_all_but_7ff(rig);
    rig.go(0x60, 0x00, 0x00);
    rig.peer_sends(frame);
    EXPECT_EQ(rig.read(0x2C), 0x00);
    EXPECT_EQ(rig.chip.events().filtered, 1U);
  }
}

TEST(Mcp2515Modes, ListenOnlyResetsTheErrorCounters) {
  ChipRig rig;
  rig.go();
  rig.silence_peer();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(5000);
  ASSERT_EQ(rig.read(0x1C), 128);
  ASSERT_EQ(rig.read(0x2D), 0x15) << "error-passive";
  rig.modify(0x30, 0x08, 0x00);
  rig.run_bits(200);
  rig.write(0x0F, 0x60);
  rig.run_bits(12);
  ASSERT_EQ(rig.read(0x0E) & 0xE0, 0x60);
  EXPECT_EQ(rig.read(0x1C), 0);
  EXPECT_EQ(rig.read(0x2D), 0x00);
}

}  // namespace
}  // namespace roio::test
