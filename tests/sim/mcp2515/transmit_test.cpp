// Transmission: three buffers, their priorities, aborts, one-shot mode (datasheet, section 3).
#include "chip_rig.hpp"

namespace roio::test {
namespace {

TEST(Mcp2515Transmit, ABufferBecomesTheFrameThatItsRegistersSay) {
  struct Row {
    const char* why;
    Bytes buffer;
    const char* frame;
  };
  const Row rows[] = {
      {"standard", {0x24, 0x60, 0x00, 0x00, 0x02, 0x5A, 0x2D}, "123 DLC 2 5A 2D"},
      {"standard: EID is not looked at", {0xFF, 0xE3, 0xFF, 0xFF, 0x00}, "7FF DLC 0"},
      {"extended", {0xD5, 0xE8, 0xDE, 0x12, 0x03, 1, 2, 3}, "1ABCDE12 DLC 3 01 02 03"},
      {"EID17 and EID16", {0x00, 0x0B, 0x00, 0x00, 0x00}, "00030000 DLC 0"},
      {"the smallest", {0x00, 0x08, 0x00, 0x00, 0x00}, "00000000 DLC 0"},
      {"standard remote", {0x24, 0x60, 0x00, 0x00, 0x44, 9, 9, 9, 9}, "123 remote DLC 4"},
      {"extended remote", {0xD5, 0xE8, 0xDE, 0x12, 0x40}, "1ABCDE12 remote DLC 0"},
      {"eight bytes",
       {0x24, 0x60, 0x00, 0x00, 0x08, 1, 2, 3, 4, 5, 6, 7, 8},
       "123 DLC 8 01 02 03 04 05 06 07 08"},
      {"DLC above 8: eight bytes",
       {0x24, 0x60, 0x00, 0x00, 0x0F, 1, 2, 3, 4, 5, 6, 7, 8},
       "123 DLC 15 01 02 03 04 05 06 07 08"},
  };
  for (const Row& row : rows) {
    for (int buffer = 0; buffer < 3; ++buffer) {
      ChipRig rig;
      rig.go();
      rig.load(buffer, row.buffer);
      rig.request_to_send(static_cast<std::uint8_t>(1 << buffer));
      rig.run_bits(200);
      EXPECT_EQ(rig.on_bus, Texts{row.frame}) << row.why;
      EXPECT_EQ(rig.violations(), Texts{}) << row.why;
    }
  }
}

TEST(Mcp2515Transmit, SuccessClearsTxreqAndSetsTheBuffersFlag) {
  for (int buffer = 0; buffer < 3; ++buffer) {
    ChipRig rig;
    rig.go();
    const auto control = static_cast<std::uint8_t>(0x30 + 0x10 * buffer);
    rig.load_standard(buffer, 0x123);
    rig.write(control, 0x0A);  // request and priority in one write
    rig.run_bits(20);
    EXPECT_EQ(rig.read(control), 0x0A);
    EXPECT_EQ(rig.read(0x2C), 0x00);
    rig.run_bits(100);
    EXPECT_EQ(rig.read(control), 0x02);
    EXPECT_EQ(rig.read(0x2C), 0x04 << buffer);
    EXPECT_EQ(rig.chip.events().sent, 1U);
  }
}

TEST(Mcp2515Transmit, BitModifyRequestsToo) {
  ChipRig rig;
  rig.go();
  rig.load_standard(1, 0x123);
  rig.modify(0x40, 0x08, 0x08);
  rig.run_bits(100);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
}

TEST(Mcp2515Transmit, RequestsWaitForNormalMode) {
  ChipRig rig;
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.go(0x60);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{}) << "neither in configuration nor in listen-only mode";
  EXPECT_EQ(rig.read(0x30), 0x08);
  rig.write(0x0F, 0x00);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
}

// --- priority (3.2) ------------------------------------------------------------------------------

TEST(Mcp2515Transmit, TheHighestPriorityGoesFirstAndAmongEqualsTheHighestBuffer) {
  struct Row {
    const char* why;
    Bytes priorities;
    Texts order;
  };
  const Texts two_one_zero{"002 DLC 1 5A", "001 DLC 1 5A", "000 DLC 1 5A"};
  const Texts zero_one_two{"000 DLC 1 5A", "001 DLC 1 5A", "002 DLC 1 5A"};
  const Row rows[] = {
      {"all lowest: from the highest buffer down, whatever the identifiers",
       {0, 0, 0},
       two_one_zero},
      {"all highest", {3, 3, 3}, two_one_zero},
      {"against the buffers' order", {3, 2, 1}, zero_one_two},
      {"with it", {0, 1, 2}, two_one_zero},
      {"one above the rest", {0, 1, 0}, {"001 DLC 1 5A", "002 DLC 1 5A", "000 DLC 1 5A"}},
      {"two equal on top", {1, 1, 0}, {"001 DLC 1 5A", "000 DLC 1 5A", "002 DLC 1 5A"}},
      {"two equal below", {1, 2, 1}, {"001 DLC 1 5A", "002 DLC 1 5A", "000 DLC 1 5A"}},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.go();
    for (std::uint8_t buffer = 0; buffer < 3; ++buffer) {
      rig.load_standard(buffer, buffer);
      rig.write(static_cast<std::uint8_t>(0x30 + 0x10 * buffer), row.priorities[buffer]);
    }
    rig.request_to_send(7);
    rig.run_bits(300);
    EXPECT_EQ(rig.on_bus, row.order) << row.why;
  }
}

TEST(Mcp2515Transmit, PriorityIsLookedAtBeforeEachFrameAndNotWithinOne) {
  ChipRig rig;
  rig.go();
  for (int buffer = 0; buffer < 3; ++buffer) {
    rig.load_standard(buffer, static_cast<std::uint32_t>(buffer));
  }
  rig.request_to_send(3);
  rig.run_bits(20);  // TXB1 is on the wire
  rig.modify(0x30, 0x03, 0x01);
  rig.request_to_send(4);
  rig.run_bits(300);
  EXPECT_EQ(rig.on_bus, (Texts{"001 DLC 1 5A", "000 DLC 1 5A", "002 DLC 1 5A"}));
  EXPECT_EQ(rig.violations(), Texts{}) << "a priority may change while the buffer is pending";
}

TEST(Mcp2515Transmit, WritingABufferThatIsPendingIsNoted) {
  ChipRig rig;
  rig.silence_peer();
  rig.go();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  EXPECT_EQ(rig.violations(), Texts{});
  rig.write(0x31, 0x00);
  rig.write(0x3D, 0x00);
  EXPECT_EQ(rig.violations().size(), 2U);
  rig.write(0x41, Bytes{0x24, 0x60});
  EXPECT_EQ(rig.violations().size(), 2U) << "the other buffers are free";
}

// --- what can go wrong ---------------------------------------------------------------------------

TEST(Mcp2515Transmit, AFrameThatLostArbitrationIsRepeated) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x124);
  rig.peer.send({0x123, FrameKind::standard, 0, {}});
  rig.request_to_send(1);
  rig.run_bits(30);
  EXPECT_EQ(rig.read(0x30), 0x28) << "MLOA, and still requested";
  EXPECT_EQ(rig.read(0x2C), 0x00) << "losing is no error";
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"124 DLC 1 5A"});
  EXPECT_EQ(rig.read(0x30) & 0x08, 0x00);
  EXPECT_EQ(rig.read(0x2C), 0x05) << "TX0IF, and the winner in RXB0";
  EXPECT_EQ(rig.read(0x1C), 0x00);
}

TEST(Mcp2515Transmit, AnUnacknowledgedFrameIsRepeatedForEver) {
  ChipRig rig;
  rig.silence_peer();
  rig.go();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(65);
  EXPECT_EQ(rig.read(0x30), 0x18) << "TXERR, and still requested";
  EXPECT_EQ(rig.read(0x2C), 0x80) << "MERRF";
  EXPECT_EQ(rig.read(0x1C), 8);
  rig.request_to_send(1);
  EXPECT_EQ(rig.read(0x30), 0x18) << "asking again changes nothing";
  rig.bus.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(rig.read(0x1C), 128) << "a lone node never goes bus-off";
  EXPECT_EQ(rig.read(0x30), 0x18);
  rig.wake_peer();
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
  EXPECT_EQ(rig.read(0x1C), 127);
  EXPECT_EQ(rig.chip.events().sent, 1U);
}

TEST(Mcp2515Transmit, ANewRequestClearsTheFlagsOfTheLast) {
  ChipRig rig;
  rig.silence_peer();
  rig.go(0x08);
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(100);
  ASSERT_EQ(rig.read(0x30), 0x50);
  rig.write(0x30, 0x03);
  EXPECT_EQ(rig.read(0x30), 0x53) << "software cannot clear them";
  rig.request_to_send(1);
  EXPECT_EQ(rig.read(0x30), 0x0B);
}

// --- abort (3.6) ---------------------------------------------------------------------------------

TEST(Mcp2515Transmit, ABufferIsTakenBackByClearingItsTxreq) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x100);
  rig.load_standard(2, 0x102);
  rig.request_to_send(5);
  rig.run_bits(20);  // TXB2 is on the wire
  rig.modify(0x30, 0x08, 0x00);
  EXPECT_EQ(rig.read(0x30), 0x00) << "without ABTF";
  rig.run_bits(300);
  EXPECT_EQ(rig.on_bus, Texts{"102 DLC 1 5A"});
  EXPECT_EQ(rig.read(0x2C), 0x10);
  EXPECT_EQ(rig.chip.events().aborted, 1U);
}

TEST(Mcp2515Transmit, WhatIsOnTheWireIsNotTakenBack) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(20);
  rig.write(0x30, 0x00);
  EXPECT_EQ(rig.read(0x30), 0x00);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
  EXPECT_EQ(rig.read(0x2C), 0x04);
  EXPECT_EQ(rig.chip.events().aborted, 0U);
}

TEST(Mcp2515Transmit, ButItIsNotRepeatedWhenItFails) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  rig.run_bits(30);
  rig.write(0x30, 0x00);
  rig.bus.flip_next_bit();
  rig.run_bits(300);
  EXPECT_EQ(rig.on_bus, Texts{});
  EXPECT_EQ(rig.read(0x30), 0x10) << "TXERR without ABTF";
  EXPECT_EQ(rig.read(0x2C), 0x80);
  EXPECT_EQ(rig.chip.events().aborted, 1U);
}

TEST(Mcp2515Transmit, AbatTakesBackAllThatWait) {
  ChipRig rig;
  rig.go();
  for (int buffer = 0; buffer < 3; ++buffer) {
    rig.load_standard(buffer, static_cast<std::uint32_t>(buffer));
  }
  rig.request_to_send(7);
  rig.run_bits(20);  // TXB2 is on the wire
  rig.modify(0x0F, 0x10, 0x10);
  EXPECT_EQ(rig.read(0x30), 0x40) << "ABTF";
  EXPECT_EQ(rig.read(0x40), 0x40);
  EXPECT_EQ(rig.read(0x50), 0x08) << "the one on the wire goes on";
  rig.run_bits(300);
  EXPECT_EQ(rig.on_bus, Texts{"002 DLC 1 5A"});
  EXPECT_EQ(rig.read(0x50), 0x00) << "it was not aborted";
  EXPECT_EQ(rig.read(0x2C), 0x10) << "an abort sets no flag";
  EXPECT_EQ(rig.chip.events().aborted, 2U);
}

TEST(Mcp2515Transmit, AbatEndsAFrameThatFailsAfterIt) {
  struct Row {
    const char* why;
    bool loses;
    int txb0ctrl;
  };
  constexpr Row rows[] = {{"arbitration lost", true, 0x60}, {"bit error", false, 0x50}};
  for (const Row& row : rows) {
    ChipRig rig;
    rig.go();
    rig.load_standard(0, 0x7FF);
    if (row.loses) {
      rig.peer.send({0x7FE, FrameKind::standard, 0, {}});
    }
    rig.request_to_send(1);
    rig.run_bits(row.loses ? 5 : 30);
    rig.modify(0x0F, 0x10, 0x10);
    EXPECT_EQ(rig.read(0x30), 0x08) << row.why;
    if (!row.loses) {
      rig.bus.flip_next_bit();
    }
    rig.run_bits(300);
    EXPECT_EQ(rig.on_bus, Texts{}) << row.why;
    EXPECT_EQ(rig.read(0x30), row.txb0ctrl) << row.why;
    EXPECT_EQ(rig.read(0x2C) & 0x04, 0x00) << row.why;
  }
}

TEST(Mcp2515Transmit, AbatStaysUntilSoftwareClearsIt) {
  ChipRig rig;
  rig.go();
  rig.load_standard(0, 0x123);
  rig.modify(0x0F, 0x10, 0x10);
  rig.request_to_send(1);
  EXPECT_EQ(rig.read(0x30), 0x40) << "given up at once";
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{});
  EXPECT_EQ(rig.read(0x0F), 0x10);
  rig.modify(0x0F, 0x10, 0x00);
  rig.request_to_send(1);
  EXPECT_EQ(rig.read(0x30), 0x08);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"});
}

// --- one-shot mode (3.5) -------------------------------------------------------------------------

TEST(Mcp2515Transmit, OneShotModeTriesOnce) {
  enum class Fate : std::uint8_t { sent, loses, unacknowledged };
  struct Row {
    const char* why;
    Fate fate;
    int txb0ctrl;
    int canintf;
    std::uint64_t aborted;
  };
  constexpr Row rows[] = {
      {"sent: TX0IF alone", Fate::sent, 0x00, 0x04, 0},
      {"arbitration lost: ABTF, MLOA; the winner in RXB0", Fate::loses, 0x60, 0x01, 1},
      {"no acknowledgement: ABTF, TXERR, MERRF", Fate::unacknowledged, 0x50, 0x80, 1},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.go(0x08);
    rig.load_standard(0, 0x124);
    if (row.fate == Fate::loses) {
      rig.peer.send({0x123, FrameKind::standard, 0, {}});
    } else if (row.fate == Fate::unacknowledged) {
      rig.silence_peer();
    }
    rig.request_to_send(1);
    rig.run_bits(500);
    EXPECT_EQ(rig.read(0x30), row.txb0ctrl) << row.why;
    EXPECT_EQ(rig.read(0x2C), row.canintf) << row.why;
    EXPECT_EQ(rig.on_bus.size(), row.fate == Fate::sent ? 1U : 0U) << row.why;
    EXPECT_EQ(rig.chip.events().aborted, row.aborted) << row.why;
  }
}

TEST(Mcp2515Transmit, OneShotModeWaitsForTheBus) {
  ChipRig rig;
  rig.go(0x08);
  rig.load_standard(0, 0x124);
  rig.peer.send({0x123, FrameKind::standard, 0, {}});
  rig.run_bits(30);
  rig.request_to_send(1);
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"124 DLC 1 5A"}) << "a busy bus is no attempt";
}

}  // namespace
}  // namespace roio::test
