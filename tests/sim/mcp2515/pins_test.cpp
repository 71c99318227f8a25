// Interrupt pin and code, RXnBF and TXnRTS pins (datasheet, sections 3.4, 4.4 and 7).
#include <optional>

#include "chip_rig.hpp"

namespace roio::test {
namespace {

// --- interrupts (7) ------------------------------------------------------------------------------

TEST(Mcp2515Pins, EachInterruptNeedsItsFlagAndItsEnableBit) {
  struct Row {
    const char* name;
    std::uint8_t flag;
    int icod;
  };
  constexpr Row rows[] = {
      {"RX0I", 0x01, 6}, {"RX1I", 0x02, 7}, {"TX0I", 0x04, 3}, {"TX1I", 0x08, 4},
      {"TX2I", 0x10, 5}, {"ERRI", 0x20, 1}, {"WAKI", 0x40, 2}, {"MERR has no code", 0x80, 0},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    const auto others = static_cast<std::uint8_t>(~row.flag);
    rig.write(0x2B, Bytes{others, row.flag});
    EXPECT_TRUE(rig.chip.interrupt_pin()) << row.name << ": not enabled";
    EXPECT_EQ(rig.read(0x0E), 0x80) << row.name;
    rig.write(0x2B, Bytes{row.flag, others});
    EXPECT_TRUE(rig.chip.interrupt_pin()) << row.name << ": not set";
    EXPECT_EQ(rig.read(0x0E), 0x80) << row.name;
    rig.write(0x2C, row.flag);
    EXPECT_FALSE(rig.chip.interrupt_pin()) << row.name;
    EXPECT_EQ(rig.read(0x0E), 0x80 | row.icod << 1) << row.name;
    rig.modify(0x2C, row.flag, 0x00);
    EXPECT_TRUE(rig.chip.interrupt_pin()) << row.name;
  }
}

TEST(Mcp2515Pins, TheInterruptCodeIsOfTheHighestPriority) {
  struct Row {
    std::uint8_t flag;
    int icod;
  };
  constexpr Row in_order[] = {{0x20, 1}, {0x40, 2}, {0x04, 3}, {0x08, 4},
                              {0x10, 5}, {0x01, 6}, {0x02, 7}};
  ChipRig rig;
  rig.write(0x2B, Bytes{0xFF, 0xFF});
  for (const Row& row : in_order) {
    EXPECT_EQ(rig.read(0x0E), 0x80 | row.icod << 1);
    rig.modify(0x2C, row.flag, 0x00);
  }
  EXPECT_EQ(rig.read(0x0E), 0x80);
  EXPECT_FALSE(rig.chip.interrupt_pin()) << "MERRF is left";
}

TEST(Mcp2515Pins, TheInterruptPinIsALevel) {
  ChipRig rig;
  std::vector<bool> edges;
  rig.chip.on_interrupt_pin([&](bool level) { edges.push_back(level); });
  rig.write(0x2B, 0x03);
  rig.go(0x00, 0x64, 0x60);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(edges, (std::vector<bool>{false}));
  rig.spi({0x90});
  EXPECT_EQ(edges, (std::vector<bool>{false})) << "RXB1 is still full";
  rig.spi({0x94});
  EXPECT_EQ(edges, (std::vector<bool>{false, true}));
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  rig.write(0x2B, 0x00);
  EXPECT_EQ(edges, (std::vector<bool>{false, true, false, true})) << "disabling lifts it, too";
  rig.write(0x2B, 0x03);
  rig.chip.reset_pin();
  EXPECT_EQ(edges, (std::vector<bool>{false, true, false, true, false, true}));
}

TEST(Mcp2515Pins, AFlagIsSetWhetherEnabledOrNot) {
  ChipRig rig;
  rig.go();
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C), 0x01);
  EXPECT_TRUE(rig.chip.interrupt_pin());
  rig.write(0x2B, 0x01);
  EXPECT_FALSE(rig.chip.interrupt_pin());
}

// --- RXnBF (4.4) ---------------------------------------------------------------------------------

TEST(Mcp2515Pins, RxnbfFollowBfpctrl) {
  using Level = std::optional<bool>;
  struct Row {
    const char* why;
    std::uint8_t bfpctrl;
    std::uint8_t canintf;
    Level rx0bf;
    Level rx1bf;
    int reads;
  };
  const Row rows[] = {
      {"both off: they float", 0x00, 0x03, {}, {}, 0x00},
      {"a mode alone does not enable", 0x33, 0x03, {}, {}, 0x03},
      {"RX0BF as output, low", 0x04, 0x03, false, {}, 0x04},
      {"RX0BF as output, high", 0x14, 0x00, true, {}, 0x14},
      {"RX1BF as output, low", 0x08, 0x03, {}, false, 0x08},
      {"RX1BF as output, high", 0x28, 0x00, {}, true, 0x28},
      {"RX0BF shows its buffer: empty", 0x05, 0x02, true, {}, 0x05},
      {"RX0BF shows its buffer: full", 0x05, 0x01, false, {}, 0x05},
      {"RX1BF shows its buffer: empty", 0x0A, 0x01, {}, true, 0x0A},
      {"RX1BF shows its buffer: full", 0x0A, 0x02, {}, false, 0x0A},
      {"BFS of a pin that shows its buffer does nothing and reads as 0", 0x3F, 0x01, false, true,
       0x0F},
      {"one of each", 0x2D, 0x01, false, true, 0x2D},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.write(0x0C, row.bfpctrl);
    rig.write(0x2C, row.canintf);
    EXPECT_EQ(rig.chip.receive_buffer_pin(0), row.rx0bf) << row.why;
    EXPECT_EQ(rig.chip.receive_buffer_pin(1), row.rx1bf) << row.why;
    EXPECT_EQ(rig.read(0x0C), row.reads) << row.why;
  }
}

TEST(Mcp2515Pins, RxnbfRisesWhenTheBufferIsFreed) {
  ChipRig rig;
  rig.write(0x0C, 0x0F);
  rig.go();
  EXPECT_EQ(rig.chip.receive_buffer_pin(0), true);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.chip.receive_buffer_pin(0), false);
  EXPECT_EQ(rig.chip.receive_buffer_pin(1), true);
  rig.spi({0x92});
  EXPECT_EQ(rig.chip.receive_buffer_pin(0), true);
}

// --- TXnRTS (3.4) --------------------------------------------------------------------------------

TEST(Mcp2515Pins, TxnrtsReadAsInputsUnlessTheyRequest) {
  struct Row {
    std::uint8_t modes;
    std::array<bool, 3> pins;
    int reads;
  };
  constexpr Row rows[] = {
      {0x00, {true, true, true}, 0x38},    {0x00, {false, true, true}, 0x30},
      {0x00, {true, false, true}, 0x28},   {0x00, {true, true, false}, 0x18},
      {0x01, {true, true, true}, 0x31},    {0x02, {true, true, true}, 0x2A},
      {0x04, {true, true, true}, 0x1C},    {0x07, {true, true, true}, 0x07},
      {0x05, {false, false, false}, 0x05},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.write(0x0D, row.modes);
    for (int pin = 0; pin < 3; ++pin) {
      rig.chip.set_request_to_send_pin(pin, row.pins.at(static_cast<std::size_t>(pin)));
    }
    EXPECT_EQ(rig.read(0x0D), row.reads);
  }
}

TEST(Mcp2515Pins, AFallingTxnrtsRequestsItsBuffer) {
  for (int pin = 0; pin < 3; ++pin) {
    ChipRig rig;
    rig.write(0x0D, static_cast<std::uint8_t>(1 << pin));
    rig.go();
    const auto control = static_cast<std::uint8_t>(0x30 + 0x10 * pin);
    for (int buffer = 0; buffer < 3; ++buffer) {
      rig.load_standard(buffer, 0x100U + static_cast<std::uint32_t>(buffer));
      rig.chip.set_request_to_send_pin(buffer, false);
    }
    EXPECT_EQ(rig.read(control), 0x08);
    rig.run_bits(300);
    EXPECT_EQ(rig.on_bus, Texts{"10" + std::to_string(pin) + " DLC 1 5A"})
        << "the other pins are inputs";
    rig.chip.set_request_to_send_pin(pin, false);
    EXPECT_EQ(rig.read(control), 0x00) << "low already";
    rig.chip.set_request_to_send_pin(pin, true);
    EXPECT_EQ(rig.read(control), 0x00) << "rising";
    rig.chip.set_request_to_send_pin(pin, false);
    EXPECT_EQ(rig.read(control), 0x08) << "falling again";
  }
}

}  // namespace
}  // namespace roio::test
