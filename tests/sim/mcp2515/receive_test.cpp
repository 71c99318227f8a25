// Reception: filters, masks, two buffers, rollover, overflow (datasheet, section 4).
#include "chip_rig.hpp"

namespace roio::test {
namespace {

TEST(Mcp2515Receive, AFrameBecomesTheRegistersThatTheDatasheetSays) {
  struct Row {
    const char* why;
    Frame frame;
    int control;  // RXM 11 in all of them
    Bytes registers;
  };
  const Row rows[] = {
      {"standard",
       {0x123, FrameKind::standard, 2, {0x5A, 0x2D}},
       0x60,
       {0x24, 0x60, 0x00, 0x00, 0x02, 0x5A, 0x2D}},
      {"standard remote: RXRTR and SRR",
       {0x123, FrameKind::standard_remote, 4, {}},
       0x68,
       {0x24, 0x70, 0x00, 0x00, 0x04}},
      {"extended: IDE",
       {0x1ABCDE12, FrameKind::extended, 3, {1, 2, 3}},
       0x60,
       {0xD5, 0xE8, 0xDE, 0x12, 0x03, 1, 2, 3}},
      {"EID17 and EID16",
       {0x00030000, FrameKind::extended, 0, {}},
       0x60,
       {0x00, 0x0B, 0x00, 0x00, 0x00}},
      {"extended remote: RXRTR, and RTR with the DLC",
       {0x1ABCDE12, FrameKind::extended_remote, 8, {}},
       0x68,
       {0xD5, 0xE8, 0xDE, 0x12, 0x48}},
      {"eight bytes",
       {0x7FF, FrameKind::standard, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
       0x60,
       {0xFF, 0xE0, 0x00, 0x00, 0x08, 1, 2, 3, 4, 5, 6, 7, 8}},
      {"DLC above 8 is kept",
       {0x7FF, FrameKind::standard, 15, {1, 2, 3, 4, 5, 6, 7, 8}},
       0x60,
       {0xFF, 0xE0, 0x00, 0x00, 0x0F, 1, 2, 3, 4, 5, 6, 7, 8}},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.go();
    rig.peer_sends(row.frame);
    EXPECT_EQ(rig.read(0x61, row.registers.size()), row.registers) << row.why;
    EXPECT_EQ(rig.read(0x60), row.control) << row.why;
    EXPECT_EQ(rig.read(0x2C), 0x01) << row.why;
  }
}

TEST(Mcp2515Receive, TheRemoteFlagIsOfTheLastMessage) {
  ChipRig rig;
  rig.go();
  rig.peer_sends({0x123, FrameKind::standard_remote, 0, {}});
  rig.write(0x2C, 0x00);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x60), 0x60);
}

TEST(Mcp2515Receive, ShorterFramesLeaveNoSecretOfTheBufferButOfTheBus) {
  ChipRig rig;
  rig.write(0x20, Bytes{0xFF, 0xE0, 0x00, 0x00});
  rig.write(0x24, Bytes{0xFF, 0xE0, 0x00, 0x00});
  for (const std::uint8_t filter : Bytes{0x00, 0x04, 0x08, 0x10, 0x14, 0x18}) {
    rig.write(filter, Bytes{0x20, 0x00, 0x00, 0x00});
  }
  rig.go(0x00, 0x00, 0x00);
  rig.peer_sends({0x100, FrameKind::standard, 4, {1, 2, 3, 4}});
  rig.spi({0x90});
  rig.peer_sends({0x555, FrameKind::standard, 8, {11, 12, 13, 14, 15, 16, 17, 18}});
  ASSERT_EQ(rig.read(0x2C), 0x00) << "filtered, and yet assembled";
  rig.peer_sends({0x100, FrameKind::standard, 1, {21}});
  EXPECT_EQ(rig.read(0x66, 8), (Bytes{21, 12, 13, 14, 15, 16, 17, 18}))
      << "all eight bytes of the assembly buffer move (4.1)";
}

// --- filters and masks (4.5) ---------------------------------------------------------------------

/// Six filters for the standard identifiers 100h to 105h, masks that compare all of them.
struct SixFilters : ChipRig {
  SixFilters(std::uint8_t rxb0ctrl, std::uint8_t rxb1ctrl, const sim::Mcp2515Options& options = {})
      : ChipRig(options) {
    write(0x20, Bytes{0xFF, 0xE0, 0x00, 0x00, 0xFF, 0xE0, 0x00, 0x00});
    write(0x00, Bytes{0x20, 0x00, 0x00, 0x00, 0x20, 0x20, 0x00, 0x00, 0x20, 0x40, 0x00, 0x00});
    write(0x10, Bytes{0x20, 0x60, 0x00, 0x00, 0x20, 0x80, 0x00, 0x00, 0x20, 0xA0, 0x00, 0x00});
    go(0x00, rxb0ctrl, rxb1ctrl);
  }
};

TEST(Mcp2515Receive, TwoFiltersLeadToRxb0AndFourToRxb1) {
  struct Row {
    std::uint32_t id;
    int canintf;
    int rxb0ctrl;
    int rxb1ctrl;
  };
  constexpr Row rows[] = {
      {0x0FF, 0x00, 0x00, 0x00}, {0x100, 0x01, 0x00, 0x00}, {0x101, 0x01, 0x01, 0x00},
      {0x102, 0x02, 0x00, 0x02}, {0x103, 0x02, 0x00, 0x03}, {0x104, 0x02, 0x00, 0x04},
      {0x105, 0x02, 0x00, 0x05}, {0x106, 0x00, 0x00, 0x00},
  };
  for (const Row& row : rows) {
    SixFilters rig(0x00, 0x00);
    rig.peer_sends({row.id, FrameKind::standard, 0, {}});
    EXPECT_EQ(rig.read(0x2C), row.canintf) << row.id;
    EXPECT_EQ(rig.read(0x60), row.rxb0ctrl) << row.id << ": FILHIT0";
    EXPECT_EQ(rig.read(0x70), row.rxb1ctrl) << row.id << ": FILHIT2..0";
    EXPECT_EQ(rig.chip.events().filtered, row.canintf == 0 ? 1U : 0U);
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(Mcp2515Receive, OfSeveralFiltersTheLowestIsTold) {
  ChipRig rig;
  rig.write(0x20, Bytes(8));  // masks of zero: every filter matches every standard frame
  for (const std::uint8_t filter : Bytes{0x00, 0x04, 0x08, 0x10, 0x14, 0x18}) {
    rig.write(filter, Bytes(4));
  }
  rig.write(0x08, Bytes{0x00, 0x08, 0x00, 0x00});  // but RXF2, which is for extended ones
  rig.go(0x00, 0x00, 0x00);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x01) << "RXB0 looks first";
  EXPECT_EQ(rig.read(0x60) & 0x01, 0);
  rig.peer_sends({0x123, FrameKind::extended, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x03);
  EXPECT_EQ(rig.read(0x70) & 0x07, 2);
}

TEST(Mcp2515Receive, EachMaskBitDecidesWhetherItsFilterBitCounts) {
  struct Row {
    const char* why;
    Bytes mask;
    Bytes filter;
    Frame frame;
    bool accepted;
  };
  constexpr FrameKind standard = FrameKind::standard;
  constexpr FrameKind extended = FrameKind::extended;
  const Row rows[] = {
      {"equal", {0xFF, 0xE0, 0, 0}, {0x24, 0x60, 0, 0}, {0x123, standard, 0, {}}, true},
      {"highest bit", {0xFF, 0xE0, 0, 0}, {0x24, 0x60, 0, 0}, {0x523, standard, 0, {}}, false},
      {"highest bit masked",
       {0x7F, 0xE0, 0, 0},
       {0x24, 0x60, 0, 0},
       {0x523, standard, 0, {}},
       true},
      {"lowest bit", {0xFF, 0xE0, 0, 0}, {0x24, 0x60, 0, 0}, {0x122, standard, 0, {}}, false},
      {"lowest bit masked", {0xFF, 0xC0, 0, 0}, {0x24, 0x60, 0, 0}, {0x122, standard, 0, {}}, true},
      {"no bit counts", {0, 0, 0, 0}, {0x24, 0x60, 0, 0}, {0x7FF, standard, 0, {}}, true},
      {"EXIDE 0 refuses extended", {0, 0, 0, 0}, {0, 0, 0, 0}, {0, extended, 0, {}}, false},
      {"EXIDE 1 refuses standard", {0, 0, 0, 0}, {0, 0x08, 0, 0}, {0, standard, 0, {}}, false},
      {"EXIDE 1 takes extended",
       {0, 0, 0, 0},
       {0, 0x08, 0, 0},
       {0x1FFFFFFF, extended, 0, {}},
       true},
      {"all 29 bits",
       {0xFF, 0xE3, 0xFF, 0xFF},
       {0xD5, 0xE8, 0xDE, 0x12},
       {0x1ABCDE12, extended, 0, {}},
       true},
      {"EID0, lowest bit",
       {0xFF, 0xE3, 0xFF, 0xFF},
       {0xD5, 0xE8, 0xDE, 0x12},
       {0x1ABCDE13, extended, 0, {}},
       false},
      {"EID0 masked",
       {0xFF, 0xE3, 0xFF, 0x00},
       {0xD5, 0xE8, 0xDE, 0x12},
       {0x1ABCDEFF, extended, 0, {}},
       true},
      {"EID8, highest bit",
       {0xFF, 0xE3, 0xFF, 0x00},
       {0xD5, 0xE8, 0xDE, 0x12},
       {0x1ABC5E12, extended, 0, {}},
       false},
      {"EID17",
       {0xFF, 0xE3, 0xFF, 0x00},
       {0xD5, 0xE8, 0xDE, 0x12},
       {0x1ABEDE12, extended, 0, {}},
       false},
      {"EID17 masked",
       {0xFF, 0xE1, 0xFF, 0x00},
       {0xD5, 0xE8, 0xDE, 0x12},
       {0x1ABEDE12, extended, 0, {}},
       true},
      {"standard: EID8 is the first data byte",
       {0xFF, 0xE0, 0xFF, 0},
       {0x24, 0x60, 0x5A, 0},
       {0x123, standard, 1, {0x5A}},
       true},
      {"another first byte",
       {0xFF, 0xE0, 0xFF, 0},
       {0x24, 0x60, 0x5A, 0},
       {0x123, standard, 1, {0x5B}},
       false},
      {"one bit of the first byte",
       {0xFF, 0xE0, 0x80, 0},
       {0x24, 0x60, 0x80, 0},
       {0x123, standard, 1, {0xFF}},
       true},
      {"EID0 is the second",
       {0xFF, 0xE0, 0xFF, 0xFF},
       {0x24, 0x60, 0x5A, 0x2D},
       {0x123, standard, 2, {0x5A, 0x2D}},
       true},
      {"another second byte",
       {0xFF, 0xE0, 0xFF, 0xFF},
       {0x24, 0x60, 0x5A, 0x2D},
       {0x123, standard, 2, {0x5A, 0x2C}},
       false},
      {"a third is not looked at",
       {0xFF, 0xE0, 0xFF, 0xFF},
       {0x24, 0x60, 0x5A, 0x2D},
       {0x123, standard, 3, {0x5A, 0x2D, 0x77}},
       true},
      {"EID17 and EID16 do not count in standard frames",
       {0xFF, 0xE3, 0x00, 0x00},
       {0x24, 0x63, 0x00, 0x00},
       {0x123, standard, 2, {0x00, 0x00}},
       true},
      {"a byte that is not there matches",
       {0xFF, 0xE0, 0xFF, 0xFF},
       {0x24, 0x60, 0x5A, 0x2D},
       {0x123, standard, 1, {0x5A}},
       true},
      {"so does the DLC of a remote frame",
       {0xFF, 0xE0, 0xFF, 0xFF},
       {0x24, 0x60, 0x5A, 0x2D},
       {0x123, FrameKind::standard_remote, 2, {}},
       true},
  };
  for (const Row& row : rows) {
    // Each of the six filters in its turn; the others never match.
    for (const std::uint8_t filter : Bytes{0x00, 0x04, 0x08, 0x10, 0x14, 0x18}) {
      ChipRig rig;
      const bool extended_others = !is_extended(row.frame.kind);
      for (const std::uint8_t other : Bytes{0x00, 0x04, 0x08, 0x10, 0x14, 0x18}) {
        rig.write(other, Bytes{0x00, static_cast<std::uint8_t>(extended_others ? 0x08 : 0x00), 0x00,
                               0x00});
      }
      rig.write(filter, row.filter);
      rig.write(filter < 0x08 ? 0x20 : 0x24, row.mask);
      rig.go(0x00, 0x00, 0x00);
      rig.peer_sends(row.frame);
      const int expected = !row.accepted ? 0x00 : filter < 0x08 ? 0x01 : 0x02;
      EXPECT_EQ(rig.read(0x2C), expected) << row.why << ", filter at " << int{filter};
    }
  }
}

TEST(Mcp2515Receive, RxmTurnsTheFiltersOff) {
  struct Row {
    const char* why;
    std::uint8_t rxb0ctrl;
    std::uint8_t rxb1ctrl;
    FrameKind kind;
    std::uint32_t id;
    int canintf;
  };
  constexpr Row rows[] = {
      {"RXB0 takes any", 0x60, 0x00, FrameKind::standard, 0x7FF, 0x01},
      {"extended ones, too", 0x60, 0x00, FrameKind::extended, 0x7FF, 0x01},
      {"RXB1 takes any", 0x00, 0x60, FrameKind::extended, 0x7FF, 0x02},
      {"RXB0 still looks first", 0x00, 0x60, FrameKind::standard, 0x100, 0x01},
      {"neither", 0x00, 0x00, FrameKind::standard, 0x7FF, 0x00},
  };
  for (const Row& row : rows) {
    SixFilters rig(row.rxb0ctrl, row.rxb1ctrl);
    rig.peer_sends({row.id, row.kind, 0, {}});
    EXPECT_EQ(rig.read(0x2C), row.canintf) << row.why;
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(Mcp2515Receive, ReservedRxmsAreNotedAndFilterByKind) {
  struct Row {
    const char* why;
    std::uint8_t rxb0ctrl;
    std::uint32_t id;
    int canintf;
  };
  constexpr Row rows[] = {
      {"01 took standard messages that meet a filter", 0x20, 0x100, 0x01},
      {"not those that do not", 0x20, 0x7FF, 0x00},
      {"10 took extended messages only", 0x40, 0x100, 0x00},
  };
  for (const Row& row : rows) {
    SixFilters rig(row.rxb0ctrl, 0x00);
    rig.peer_sends({row.id, FrameKind::standard, 0, {}});
    EXPECT_EQ(rig.read(0x2C), row.canintf) << row.why;
    EXPECT_EQ(rig.violations(), Texts{"RXM 01 and 10 are reserved"});
  }
}

// --- rollover and overflow (figure 4-3) ----------------------------------------------------------

TEST(Mcp2515Receive, FollowsTheFlowChart) {
  constexpr std::uint32_t rxb0 = 0x101;  // RXF1
  constexpr std::uint32_t rxb1 = 0x104;  // RXF4
  struct Row {
    const char* why;
    std::uint8_t rxb0ctrl;
    std::vector<std::uint32_t> ids;
    int canintf;
    int eflg;
    Bytes first_bytes;  // of RXB0 and RXB1, where full: the number of the frame in them
  };
  const Row rows[] = {
      {"RXB0 free", 0x00, {rxb0}, 0x01, 0x00, {0}},
      {"RXB0 full, no rollover: RX0OVR, and the first frame stays",
       0x00,
       {rxb0, rxb0},
       0x21,
       0x40,
       {0}},
      {"RXB0 full, rollover", 0x04, {rxb0, rxb0}, 0x03, 0x00, {0, 1}},
      {"both full, rollover: RX1OVR", 0x04, {rxb0, rxb0, rxb0}, 0x23, 0x80, {0, 1}},
      {"RXB1 free", 0x00, {rxb1}, 0x02, 0x00, {0xFF, 0}},
      {"RXB1 full: RX1OVR", 0x00, {rxb1, rxb1}, 0x22, 0x80, {0xFF, 0}},
      {"RXB1 full: nothing rolls back into RXB0", 0x04, {rxb1, rxb1}, 0x22, 0x80, {0xFF, 0}},
      {"RXB1 full by its own, rollover", 0x04, {rxb1, rxb0, rxb0}, 0x23, 0x80, {1, 0}},
      {"each overflows", 0x00, {rxb0, rxb1, rxb0, rxb1}, 0x23, 0xC0, {0, 1}},
  };
  for (const Row& row : rows) {
    SixFilters rig(row.rxb0ctrl, 0x00);
    std::uint8_t number = 0;
    for (const std::uint32_t id : row.ids) {
      rig.peer_sends({id, FrameKind::standard, 1, {number++}});
    }
    EXPECT_EQ(rig.read(0x2C), row.canintf) << row.why;
    EXPECT_EQ(rig.read(0x2D), row.eflg) << row.why;
    for (std::size_t buffer = 0; buffer < row.first_bytes.size(); ++buffer) {
      if (row.first_bytes[buffer] != 0xFF) {
        EXPECT_EQ(rig.read(buffer == 0 ? 0x66 : 0x76), row.first_bytes[buffer]) << row.why;
      }
    }
    EXPECT_EQ(rig.chip.events().accepted + rig.chip.events().overflowed, row.ids.size());
  }
}

TEST(Mcp2515Receive, ARolledOverMessageNeedNotMatchTheFiltersOfRxb1) {
  SixFilters rig(0x04, 0x00);
  rig.peer_sends({0x101, FrameKind::standard, 0, {}});
  rig.peer_sends({0x101, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x03);
  EXPECT_EQ(rig.read(0x70) & 0x07, 1) << "the filter of RXB0 that took it";
}

TEST(Mcp2515Receive, WithoutRolloverRxb1DoesNotTakeWhatRxb0Lost) {
  ChipRig rig;
  rig.go(0x00, 0x60, 0x60);  // both would take any message
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x21);
  EXPECT_EQ(rig.read(0x2D), 0x40);
}

TEST(Mcp2515Receive, WhichFlagTellsThatBothAreFullIsAnOption) {
  SixFilters rig(0x04, 0x00, {.full_sets_rx0ovr = true});
  for (int i = 0; i < 3; ++i) {
    rig.peer_sends({0x101, FrameKind::standard, 0, {}});
  }
  EXPECT_EQ(rig.read(0x2D), 0x40);
}

TEST(Mcp2515Receive, OverflowFlagsStayUntilSoftwareClearsThem) {
  SixFilters rig(0x00, 0x00);
  rig.peer_sends({0x100, FrameKind::standard, 0, {}});
  rig.peer_sends({0x100, FrameKind::standard, 0, {}});
  rig.write(0x2C, 0x00);
  rig.peer_sends({0x100, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x01) << "room again, and no new overflow";
  EXPECT_EQ(rig.read(0x2D), 0x40);
  rig.peer_sends({0x100, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x21) << "the next one interrupts again";
  rig.modify(0x2D, 0x40, 0x00);
  EXPECT_EQ(rig.read(0x2D), 0x00);
}

TEST(Mcp2515Receive, ReceiversAcknowledgeWhatTheyFilterOrLose) {
  SixFilters rig(0x00, 0x00);
  for (const std::uint32_t id : {0x555U, 0x100U, 0x100U}) {
    rig.peer_sends({id, FrameKind::standard, 0, {}});
  }
  EXPECT_EQ(rig.bus.statistics().transmit_errors, 0U);
  EXPECT_EQ(rig.bus.statistics().frames, 3U);
}

TEST(Mcp2515Receive, ABrokenFrameIsNotReceived) {
  ChipRig rig;
  rig.go();
  rig.peer.send({0x123, FrameKind::standard, 2, {0x55, 0xAA}});
  rig.run_bits(30);
  rig.bus.flip_next_bit(&rig.chip.controller());
  rig.run_bits(45);
  EXPECT_EQ(rig.read(0x2C), 0x80) << "MERRF";
  EXPECT_GT(rig.read(0x1D), 0);
  rig.run_bits(300);
  EXPECT_EQ(rig.read(0x2C), 0x81) << "it comes again";
}

}  // namespace
}  // namespace roio::test
