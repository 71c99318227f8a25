// The nine SPI instructions, bit for bit (datasheet, section 12).
#include <set>

#include "chip_rig.hpp"

namespace roio::test {
namespace {

TEST(Mcp2515Spi, ReadGoesOnToTheNextRegister) {
  ChipRig rig;
  rig.write(0x28, Bytes{0x02, 0xB4, 0x01});
  EXPECT_EQ(rig.spi({0x03, 0x28, 0xFF, 0xFF, 0xFF}), (Bytes{0x00, 0x00, 0x02, 0xB4, 0x01}))
      << "what the master sends meanwhile does not matter";
}

TEST(Mcp2515Spi, WriteGoesOnToTheNextRegister) {
  ChipRig rig;
  EXPECT_EQ(rig.spi({0x02, 0x28, 0x03, 0xF0, 0x41}), Bytes(5)) << "nothing to read";
  EXPECT_EQ(rig.read(0x28, 3), (Bytes{0x03, 0xF0, 0x41}));
}

TEST(Mcp2515Spi, TheAddressWrapsAround) {
  ChipRig rig;
  rig.write(0x00, Bytes{0x12, 0x20});
  EXPECT_EQ(rig.read(0x7E, 4), (Bytes{0x80, 0x87, 0x12, 0x20}));
  rig.write(0x7F, Bytes{0x84, 0x99});
  EXPECT_EQ(rig.read(0x0F), 0x84);
  EXPECT_EQ(rig.read(0x00), 0x99);
  EXPECT_EQ(rig.violations(), Texts{});
}

TEST(Mcp2515Spi, AllRegistersInOneRead) {
  ChipRig rig;
  const Bytes twice = rig.read(0x00, 256);
  EXPECT_EQ(Bytes(twice.begin(), twice.begin() + 128), Bytes(twice.begin() + 128, twice.end()));
  EXPECT_EQ(twice[0x0E], 0x80);
  EXPECT_EQ(twice[0x0F], 0x87);
}

TEST(Mcp2515Spi, AddressesAbove7fAreNoted) {
  ChipRig rig;
  rig.read(0x7F);
  EXPECT_EQ(rig.violations().size(), 0U);
  EXPECT_EQ(rig.read(0x8E), 0x80) << "the highest bit is not looked at";
  EXPECT_EQ(rig.violations().size(), 1U);
}

TEST(Mcp2515Spi, BitModifyTakesOneByte) {
  ChipRig rig;
  rig.write(0x2B, Bytes{0x00, 0x00});
  EXPECT_EQ(rig.spi({0x05, 0x2B, 0x0F, 0xFF, 0x00}), Bytes(5));
  EXPECT_EQ(rig.read(0x2B, 2), (Bytes{0x0F, 0x00})) << "neither again nor in the next register";
}

TEST(Mcp2515Spi, InstructionsCutShortDoNothing) {
  struct Row {
    const char* why;
    Bytes bytes;
  };
  const Row rows[] = {
      {"no instruction at all", {}},
      {"WRITE without address", {0x02}},
      {"WRITE without data", {0x02, 0x2B}},
      {"BIT MODIFY without address", {0x05}},
      {"BIT MODIFY without mask", {0x05, 0x2B}},
      {"BIT MODIFY without data", {0x05, 0x2B, 0xFF}},
      {"READ without address", {0x03}},
      {"LOAD TX BUFFER without data", {0x40}},
      {"READ STATUS without its answer", {0xA0}},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    const Bytes before = rig.read(0x00, 128);
    rig.spi(row.bytes);
    EXPECT_EQ(rig.read(0x00, 128), before) << row.why;
    EXPECT_EQ(rig.violations(), Texts{}) << row.why;
  }
}

TEST(Mcp2515Spi, WhatWasWrittenBeforeChipSelectRoseStays) {
  ChipRig rig;
  rig.chip.select();
  for (const std::uint8_t byte : Bytes{0x02, 0x29, 0xB4}) {
    rig.chip.exchange(byte);
  }
  EXPECT_EQ(rig.chip.peek(0x29), 0xB4) << "byte by byte, not at the end";
  rig.chip.deselect();
  EXPECT_EQ(rig.chip.exchange(0x00), 0xFF) << "nobody drives the line";
  EXPECT_EQ(rig.read(0x29, 2), (Bytes{0xB4, 0x00}));
}

TEST(Mcp2515Spi, NotSelectedItHearsNothing) {
  ChipRig rig;
  for (const std::uint8_t byte : Bytes{0x02, 0x29, 0xB4}) {
    EXPECT_EQ(rig.chip.exchange(byte), 0xFF);
  }
  rig.chip.deselect();
  EXPECT_EQ(rig.read(0x29), 0x00);
  EXPECT_EQ(rig.violations(), Texts{});
}

TEST(Mcp2515Spi, ASecondSelectBeginsAnewAndIsNoted) {
  ChipRig rig;
  rig.chip.select();
  rig.chip.exchange(0x02);
  EXPECT_EQ(rig.violations().size(), 0U);
  rig.chip.select();
  EXPECT_EQ(rig.violations().size(), 1U);
  rig.chip.exchange(0x03);
  rig.chip.exchange(0x0E);
  EXPECT_EQ(rig.chip.exchange(0x00), 0x80);
  rig.chip.deselect();
}

// Table 12-1, all of them.
bool is_an_instruction(int code) {
  const std::set<int> instructions{0xC0, 0x03, 0x02, 0x05, 0xA0, 0xB0, 0x90, 0x92,
                                   0x94, 0x96, 0x40, 0x41, 0x42, 0x43, 0x44, 0x45,
                                   0x80, 0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87};
  return instructions.count(code) != 0;
}

TEST(Mcp2515Spi, OtherFirstBytesAreIgnoredAndNoted) {
  ChipRig rig;
  const Bytes before = rig.read(0x00, 128);
  for (int code = 0; code <= 0xFF; ++code) {
    if (!is_an_instruction(code)) {
      const std::size_t noted = rig.violations().size();
      EXPECT_EQ(rig.spi({static_cast<std::uint8_t>(code), 0x2B, 0xFF, 0xFF}), Bytes(4)) << code;
      EXPECT_EQ(rig.violations().size(), noted + 1) << code;
    }
  }
  EXPECT_EQ(rig.violations().size(), 256U - 24U);
  EXPECT_EQ(rig.read(0x00, 128), before);
}

TEST(Mcp2515Spi, ResetTakesEffectAtItsOneByte) {
  ChipRig rig;
  rig.go();
  rig.write(0x2B, 0x1F);
  rig.chip.select();
  rig.chip.exchange(0xC0);
  EXPECT_EQ(rig.chip.mode(), sim::Mcp2515Chip::OperationMode::configuration);
  EXPECT_EQ(rig.chip.peek(0x2B), 0x00);
  rig.chip.deselect();
  EXPECT_EQ(rig.chip.events().resets, 2U) << "and power-on";
  EXPECT_EQ(rig.violations(), Texts{});
}

// --- buffers -------------------------------------------------------------------------------------

TEST(Mcp2515Spi, LoadTxBufferBeginsAtIdentifierOrData) {
  struct Row {
    std::uint8_t code;
    std::uint8_t first;
  };
  constexpr Row rows[] = {{0x40, 0x31}, {0x41, 0x36}, {0x42, 0x41},
                          {0x43, 0x46}, {0x44, 0x51}, {0x45, 0x56}};
  for (const Row& row : rows) {
    ChipRig rig;
    EXPECT_EQ(rig.spi({row.code, 0x81, 0x42, 0x03}), Bytes(4));
    EXPECT_EQ(rig.read(row.first, 3), (Bytes{0x81, 0x42, 0x03})) << int{row.code};
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(Mcp2515Spi, ReadRxBufferBeginsAtIdentifierOrDataAndFreesTheBuffer) {
  struct Row {
    std::uint8_t code;
    Bytes expected;
    int flags_before;
    int flags_after;
  };
  const Bytes whole{0x00, 0xD5, 0xE8, 0xDE, 0x12, 0x03, 0x11, 0x22, 0x33};
  const Bytes data{0x00, 0x11, 0x22, 0x33};
  const Row rows[] = {{0x90, whole, 0x03, 0x02},
                      {0x92, data, 0x03, 0x02},
                      {0x94, whole, 0x03, 0x01},
                      {0x96, data, 0x03, 0x01}};
  for (const Row& row : rows) {
    ChipRig rig;
    rig.go(0x00, 0x64, 0x60);
    const Frame frame{0x1ABCDE12, FrameKind::extended, 3, {0x11, 0x22, 0x33}};
    rig.peer_sends(frame);
    rig.peer_sends(frame);
    ASSERT_EQ(rig.read(0x2C), row.flags_before);
    Bytes in(row.expected.size());
    in[0] = row.code;
    rig.chip.select();
    Bytes out;
    for (const std::uint8_t byte : in) {
      out.push_back(rig.chip.exchange(byte));
    }
    EXPECT_EQ(out, row.expected) << int{row.code};
    EXPECT_EQ(rig.chip.peek(0x2C), row.flags_before) << "not before chip select rises";
    rig.chip.deselect();
    EXPECT_EQ(rig.read(0x2C), row.flags_after) << int{row.code};
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(Mcp2515Spi, ReadDoesNotFreeTheBuffer) {
  ChipRig rig;
  rig.go();
  rig.peer_sends({0x123, FrameKind::standard, 1, {0x42}});
  EXPECT_EQ(rig.read(0x61, 6), (Bytes{0x24, 0x60, 0x00, 0x00, 0x01, 0x42}));
  EXPECT_EQ(rig.read(0x2C), 0x01);
}

TEST(Mcp2515Spi, AFrameThatArrivesWhileItsBufferIsReadTearsNothing) {
  ChipRig rig;
  rig.go(0x00, 0x64, 0x60);
  rig.peer_sends({0x123, FrameKind::standard, 2, {0xAA, 0xAA}});
  rig.chip.select();
  rig.chip.exchange(0x92);
  EXPECT_EQ(rig.chip.exchange(0x00), 0xAA);
  rig.peer_sends({0x123, FrameKind::standard, 2, {0xBB, 0xBB}});
  EXPECT_EQ(rig.chip.exchange(0x00), 0xAA) << "the new one has rolled over";
  rig.chip.deselect();
  EXPECT_EQ(rig.read(0x2C), 0x02);
  EXPECT_EQ(rig.read(0x76), 0xBB);
}

TEST(Mcp2515Spi, RequestToSendSetsTxreqOfTheBuffersItNames) {
  for (int buffers = 0; buffers < 8; ++buffers) {
    ChipRig rig;
    rig.chip.select();
    rig.chip.exchange(static_cast<std::uint8_t>(0x80 | buffers));
    EXPECT_EQ(rig.chip.peek(0x30) | rig.chip.peek(0x40) | rig.chip.peek(0x50), 0x00)
        << "not before chip select rises";
    rig.chip.deselect();
    EXPECT_EQ(rig.read(0x30), (buffers & 1) != 0 ? 0x08 : 0x00) << buffers;
    EXPECT_EQ(rig.read(0x40), (buffers & 2) != 0 ? 0x08 : 0x00) << buffers;
    EXPECT_EQ(rig.read(0x50), (buffers & 4) != 0 ? 0x08 : 0x00) << buffers;
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(Mcp2515Spi, AResetTakesBackWhatWaitsForChipSelect) {
  ChipRig rig;
  rig.chip.select();
  rig.chip.exchange(0x81);
  rig.chip.reset_pin();
  rig.chip.deselect();
  rig.run_bits(10);
  EXPECT_EQ(rig.read(0x30), 0x00);
}

// --- READ STATUS (figure 12-8) -------------------------------------------------------------------

TEST(Mcp2515Spi, ReadStatusShowsEightBits) {
  struct Row {
    const char* what;
    std::uint8_t address;
    std::uint8_t value;
    int status;
  };
  constexpr Row rows[] = {
      {"RX0IF", 0x2C, 0x01, 0x01},
      {"RX1IF", 0x2C, 0x02, 0x02},
      {"TXREQ of TXB0", 0x30, 0x08, 0x04},
      {"TX0IF", 0x2C, 0x04, 0x08},
      {"TXREQ of TXB1", 0x40, 0x08, 0x10},
      {"TX1IF", 0x2C, 0x08, 0x20},
      {"TXREQ of TXB2", 0x50, 0x08, 0x40},
      {"TX2IF", 0x2C, 0x10, 0x80},
      {"the other flags do not show", 0x2C, 0xE0, 0x00},
      {"nor does a priority", 0x30, 0x03, 0x00},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.write(row.address, row.value);
    EXPECT_EQ(rig.read_status(), row.status) << row.what;
  }
}

TEST(Mcp2515Spi, ReadStatusGoesOnAsLongAsItIsClocked) {
  ChipRig rig;
  rig.go();
  rig.chip.select();
  rig.chip.exchange(0xA0);
  EXPECT_EQ(rig.chip.exchange(0x00), 0x00);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.chip.exchange(0x00), 0x01) << "and shows what has happened since";
  rig.chip.deselect();
}

// --- RX STATUS (figure 12-9) ---------------------------------------------------------------------

TEST(Mcp2515Spi, RxStatusShowsBufferKindAndFilter) {
  struct Row {
    const char* why;
    std::vector<Frame> frames;
    int status;
  };
  const Frame filter0{0x100, FrameKind::standard, 0, {}};
  const Frame filter1{0x101, FrameKind::standard, 0, {}};
  const Frame filter2{0x102, FrameKind::standard, 0, {}};
  const Frame filter3{0x103, FrameKind::standard_remote, 0, {}};
  const Frame filter4{0x104 << 18, FrameKind::extended, 0, {}};
  const Frame filter5{0x105 << 18, FrameKind::extended_remote, 0, {}};
  const Row rows[] = {
      {"no message", {}, 0x00},
      {"RXB0 by RXF0, standard data", {filter0}, 0x40},
      {"RXB0 by RXF1", {filter1}, 0x41},
      {"RXB1 by RXF2", {filter2}, 0x82},
      {"RXB1 by RXF3, standard remote", {filter3}, 0x8B},
      {"RXB1 by RXF4, extended data", {filter4}, 0x94},
      {"RXB1 by RXF5, extended remote", {filter5}, 0x9D},
      {"both: RXB0 is the one described", {filter5, filter1}, 0xC1},
      {"no filter takes it", {{0x106, FrameKind::standard, 0, {}}}, 0x00},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.write(0x20, Bytes{0xFF, 0xE0, 0x00, 0x00, 0xFF, 0xE0, 0x00, 0x00});
    rig.write(0x00, Bytes{0x20, 0x00, 0x00, 0x00, 0x20, 0x20, 0x00, 0x00, 0x20, 0x40, 0x00, 0x00});
    rig.write(0x10, Bytes{0x20, 0x60, 0x00, 0x00, 0x20, 0x88, 0x00, 0x00, 0x20, 0xA8, 0x00, 0x00});
    rig.go(0x00, 0x00, 0x00);
    for (const Frame& frame : row.frames) {
      rig.peer_sends(frame);
    }
    EXPECT_EQ(rig.receive_status(), row.status) << row.why;
    EXPECT_EQ(rig.spi({0xB0, 0x00, 0x00, 0x00}),
              (Bytes{0x00, static_cast<std::uint8_t>(row.status),
                     static_cast<std::uint8_t>(row.status), static_cast<std::uint8_t>(row.status)}))
        << "the same bits again and again";
  }
}

TEST(Mcp2515Spi, RxStatusTellsARolledOverMessage) {
  for (std::uint8_t filter = 0; filter < 2; ++filter) {
    ChipRig rig;
    rig.write(0x20, Bytes{0xFF, 0xE0, 0x00, 0x00});
    rig.write(0x00, Bytes{0x20, 0x00, 0x00, 0x00, 0x20, 0x20, 0x00, 0x00});
    rig.go(0x00, 0x04, 0x00);
    const Frame frame{0x100U + filter, FrameKind::standard, 0, {}};
    rig.peer_sends(frame);
    rig.peer_sends(frame);
    EXPECT_EQ(rig.receive_status(), 0xC0 + filter);
    rig.spi({0x90, 0x00});
    EXPECT_EQ(rig.receive_status(), 0x86 + filter) << "6: RXF0 into RXB1, 7: RXF1 into RXB1";
    EXPECT_EQ(rig.read(0x70) & 0x07, filter) << "FILHIT of RXB1";
  }
}

}  // namespace
}  // namespace roio::test
