// Registers: reset values, which bits exist, who may write them and when (datasheet, section 11).
#include <algorithm>
#include <set>

#include "chip_rig.hpp"

namespace roio::test {
namespace {

struct Value {
  const char* name;
  std::uint8_t address;
  int value;
};

TEST(Mcp2515Registers, HaveTheirResetValues) {
  constexpr Value after_reset[] = {
      {"BFPCTRL: pins off", 0x0C, 0x00},
      {"TXRTSCTRL: no pin requests, all three read high", 0x0D, 0x38},
      {"CANSTAT: configuration mode, no interrupt", 0x0E, 0x80},
      {"CANCTRL: configuration mode asked for, CLKOUT at an eighth", 0x0F, 0x87},
      {"TEC", 0x1C, 0x00},
      {"REC", 0x1D, 0x00},
      {"RXM0SIDH: a mask lets everything through", 0x20, 0x00},
      {"RXM0SIDL", 0x21, 0x00},
      {"RXM0EID8", 0x22, 0x00},
      {"RXM0EID0", 0x23, 0x00},
      {"RXM1SIDH", 0x24, 0x00},
      {"RXM1SIDL", 0x25, 0x00},
      {"RXM1EID8", 0x26, 0x00},
      {"RXM1EID0", 0x27, 0x00},
      {"CNF3", 0x28, 0x00},
      {"CNF2", 0x29, 0x00},
      {"CNF1", 0x2A, 0x00},
      {"CANINTE", 0x2B, 0x00},
      {"CANINTF", 0x2C, 0x00},
      {"EFLG", 0x2D, 0x00},
      {"TXB0CTRL", 0x30, 0x00},
      {"TXB1CTRL", 0x40, 0x00},
      {"TXB2CTRL", 0x50, 0x00},
      {"RXB0CTRL", 0x60, 0x00},
      {"RXB1CTRL", 0x70, 0x00},
  };
  enum class How : std::uint8_t { power_on, instruction, pin, power_cycle };
  for (const How how : {How::power_on, How::instruction, How::pin, How::power_cycle}) {
    ChipRig rig;
    if (how != How::power_on) {
      rig.write(0x20, Bytes(8, 0xFF));
      rig.go(0x00, 0x64, 0x60);
      rig.write(0x2B, Bytes{0xFF, 0xFF, 0xC0});
      rig.write(0x30, 0x03);
      rig.write(0x0C, 0x3F);
    }
    if (how == How::instruction) {
      rig.spi({0xC0});
    } else if (how == How::pin) {
      rig.chip.reset_pin();
    } else if (how == How::power_cycle) {
      rig.chip.power_cycle();
    }
    rig.bus.run_for(std::chrono::milliseconds(1));
    for (const Value& row : after_reset) {
      EXPECT_EQ(rig.read(row.address), row.value) << row.name << ", way " << static_cast<int>(how);
    }
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

/// Filters and buffers: "unknown" after power-on.
std::vector<std::uint8_t> registers_without_reset_value() {
  std::vector<std::uint8_t> addresses;
  for (std::uint8_t address = 0; address < 0x80; ++address) {
    const bool is_filter = address < 0x0C || (address >= 0x10 && address < 0x1C);
    const int column = address & 0x0F;
    if (is_filter || (address >= 0x30 && column >= 0x1 && column <= 0xD)) {
      addresses.push_back(address);
    }
  }
  return addresses;
}

Bytes contents(ChipRig& rig) {
  Bytes values;
  for (const std::uint8_t address : registers_without_reset_value()) {
    values.push_back(static_cast<std::uint8_t>(rig.read(address)));
  }
  return values;
}

TEST(Mcp2515Registers, SomeHoldAnythingAtPowerOnAndKeepItOverAReset) {
  ChipRig one({.power_on_seed = 1});
  ChipRig other({.power_on_seed = 2});
  const Bytes before = contents(one);
  EXPECT_NE(before, contents(other)) << "a driver must not count on what is there";
  one.spi({0xC0});
  one.run_bits(100);
  EXPECT_EQ(contents(one), before);
  EXPECT_EQ(one.violations(), Texts{});
}

TEST(Mcp2515Registers, BitsThatDoNotExistReadAsZero) {
  constexpr Value existing[] = {
      {"RXF0SIDL", 0x01, 0xEB}, {"RXF5SIDL", 0x19, 0xEB}, {"TXB0SIDL", 0x32, 0xEB},
      {"TXB2DLC", 0x55, 0x4F},  {"RXB0SIDL", 0x62, 0xFB}, {"RXB1DLC", 0x75, 0x7F},
  };
  std::vector<int> seen(std::size(existing));
  for (std::uint32_t seed = 0; seed < 64; ++seed) {
    ChipRig rig({.power_on_seed = seed});
    for (std::size_t i = 0; i < std::size(existing); ++i) {
      seen[i] |= rig.read(existing[i].address);
    }
  }
  for (std::size_t i = 0; i < std::size(existing); ++i) {
    EXPECT_EQ(seen[i], existing[i].value) << existing[i].name << ": all bits that can be";
  }
}

TEST(Mcp2515Registers, TakeTheBitsTheyHave) {
  constexpr Value after_ff[] = {
      {"RXF0SIDH", 0x00, 0xFF},
      {"RXF0SIDL: SID2..0, EXIDE, EID17..16", 0x01, 0xEB},
      {"RXF0EID8", 0x02, 0xFF},
      {"RXF0EID0", 0x03, 0xFF},
      {"RXF2EID0, the last of its row", 0x0B, 0xFF},
      {"BFPCTRL: pins that show buffers read BFS as 0", 0x0C, 0x0F},
      {"TXRTSCTRL: pins that request read as 0", 0x0D, 0x07},
      {"RXF3SIDL", 0x11, 0xEB},
      {"RXF5EID0", 0x1B, 0xFF},
      {"RXM0SIDH", 0x20, 0xFF},
      {"RXM0SIDL: no EXIDE", 0x21, 0xE3},
      {"RXM1SIDL", 0x25, 0xE3},
      {"RXM1EID0", 0x27, 0xFF},
      {"CNF3: SOF, WAKFIL, PHSEG2", 0x28, 0xC7},
      {"CNF2", 0x29, 0xFF},
      {"CNF1", 0x2A, 0xFF},
      {"CANINTE", 0x2B, 0xFF},
      {"CANINTF", 0x2C, 0xFF},
      {"EFLG: only the overflow flags", 0x2D, 0xC0},
      {"TXB0CTRL: TXREQ, TXP", 0x30, 0x0B},
      {"TXB1CTRL", 0x40, 0x0B},
      {"TXB2CTRL", 0x50, 0x0B},
      {"RXB0CTRL: RXM, BUKT and its copy", 0x60, 0x66},
      {"RXB1CTRL: RXM", 0x70, 0x60},
  };
  for (const Value& row : after_ff) {
    ChipRig rig;
    rig.write(row.address, 0xFF);
    EXPECT_EQ(rig.read(row.address), row.value) << row.name;
    rig.write(row.address, 0x00);
    EXPECT_EQ(rig.read(row.address), row.address == 0x0D ? 0x38 : 0x00) << row.name;
    EXPECT_EQ(rig.violations(), Texts{}) << row.name;
  }
}

TEST(Mcp2515Registers, TransmitBuffersTakeTheBitsTheyHave) {
  const Bytes expected{0xFF, 0xEB, 0xFF, 0xFF, 0x4F, 0xFF, 0xFF,
                       0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  for (const std::uint8_t address : Bytes{0x31, 0x41, 0x51}) {
    ChipRig rig;
    rig.write(address, Bytes(13, 0xFF));
    EXPECT_EQ(rig.read(address, 13), expected);
    rig.write(address, Bytes(13, 0x00));
    EXPECT_EQ(rig.read(address, 13), Bytes(13));
    EXPECT_EQ(rig.violations(), Texts{});
  }
}

TEST(Mcp2515Registers, BuktHasAReadOnlyCopy) {
  ChipRig rig;
  rig.write(0x60, 0x04);
  EXPECT_EQ(rig.read(0x60), 0x06);
  rig.modify(0x60, 0x02, 0x00);
  EXPECT_EQ(rig.read(0x60), 0x06) << "the copy is not for writing";
  rig.modify(0x60, 0x04, 0x00);
  EXPECT_EQ(rig.read(0x60), 0x00);
}

TEST(Mcp2515Registers, StatusAndControlAreInEveryRow) {
  ChipRig rig;
  for (std::uint8_t row = 0x00; row < 0x80; row = static_cast<std::uint8_t>(row + 0x10)) {
    const auto canstat = static_cast<std::uint8_t>(row + 0xE);
    const auto canctrl = static_cast<std::uint8_t>(row + 0xF);
    EXPECT_EQ(rig.read(canstat), 0x80) << int{row};
    const auto clkout = static_cast<std::uint8_t>(0x80 | (row >> 4));
    rig.write(canctrl, clkout);
    EXPECT_EQ(rig.read(0x0F), clkout) << int{row};
    EXPECT_EQ(rig.read(0x7F), clkout) << int{row};
  }
  rig.modify(0x5F, 0x07, 0x02);
  EXPECT_EQ(rig.read(0x2F), 0x82) << "the copies take a mask, too";
  EXPECT_EQ(rig.violations(), Texts{});
}

TEST(Mcp2515Registers, ReadOnlyOnesIgnoreWritesAndThatIsNoted) {
  constexpr Value read_only[] = {
      {"CANSTAT", 0x0E, 0},  {"CANSTAT in another row", 0x7E, 0},
      {"TEC", 0x1C, 0},      {"REC", 0x1D, 0},
      {"RXB0SIDH", 0x61, 0}, {"RXB0D7", 0x6D, 0},
      {"RXB1SIDL", 0x72, 0}, {"RXB1DLC", 0x75, 0},
  };
  for (const Value& row : read_only) {
    ChipRig rig;
    const int before = rig.read(row.address);
    rig.write(row.address, static_cast<std::uint8_t>(~before));
    EXPECT_EQ(rig.read(row.address), before) << row.name;
    EXPECT_EQ(rig.violations().size(), 1U) << row.name;
  }
}

TEST(Mcp2515Registers, ANoteNamesTheRegisterAndTheTime) {
  ChipRig rig;
  rig.write(0x1C, 0x00);
  ASSERT_EQ(rig.violations(), Texts{"write to read-only register 1Ch"});
  EXPECT_EQ(rig.chip.violations()[0].time, std::chrono::milliseconds(1));
}

std::set<std::uint8_t> written_in_configuration_mode_only() {
  std::set<std::uint8_t> addresses{0x0D, 0x28, 0x29, 0x2A};
  for (const std::uint8_t first : Bytes{0x00, 0x04, 0x08, 0x10, 0x14, 0x18, 0x20, 0x24}) {
    for (std::uint8_t i = 0; i < 4; ++i) {
      addresses.insert(static_cast<std::uint8_t>(first + i));
    }
  }
  return addresses;
}

TEST(Mcp2515Registers, FiltersTimingAndPinModesAreForConfigurationModeOnly) {
  for (const std::uint8_t mode : Bytes{0x00, 0x40, 0x60}) {
    for (const std::uint8_t address : written_in_configuration_mode_only()) {
      ChipRig rig;
      rig.go(mode);
      const std::uint8_t before = rig.chip.peek(address);
      rig.write(address, static_cast<std::uint8_t>(~before));
      rig.modify(address, 0xFF, static_cast<std::uint8_t>(~before));
      EXPECT_EQ(rig.chip.peek(address), before) << int{address};
      EXPECT_GE(rig.violations().size(), 2U) << int{address} << ": neither way";
    }
  }
}

TEST(Mcp2515Registers, TheOthersAreWrittenInNormalModeToo) {
  ChipRig rig;
  rig.go();
  rig.write(0x0C, 0x3C);
  rig.write(0x2B, Bytes{0x1F, 0x03, 0x40});
  rig.write(0x50, 0x02);
  rig.write(0x31, Bytes{0x12, 0x20});
  rig.write(0x70, 0x00);
  EXPECT_EQ(rig.read(0x0C), 0x3C);
  EXPECT_EQ(rig.read(0x2B, 3), (Bytes{0x1F, 0x03, 0x40}));
  EXPECT_EQ(rig.read(0x50), 0x02);
  EXPECT_EQ(rig.read(0x31, 2), (Bytes{0x12, 0x20}));
  EXPECT_EQ(rig.read(0x70), 0x00);
  EXPECT_EQ(rig.violations(), Texts{});
}

TEST(Mcp2515Registers, FiltersAndMasksReadAsZeroOutsideConfigurationMode) {
  ChipRig rig;
  rig.write(0x00, Bytes{0x12, 0x20, 0x34, 0x56});
  rig.write(0x24, Bytes{0xFF, 0xE3, 0xFF, 0xFF});
  rig.go();
  EXPECT_EQ(rig.read(0x00, 4), Bytes(4));
  EXPECT_EQ(rig.read(0x24, 4), Bytes(4));
  EXPECT_EQ(rig.read(0x28, 3), (Bytes{0x02, 0xB4, 0x00})) << "bit timing can be read";
  rig.write(0x0F, 0x80);
  EXPECT_EQ(rig.read(0x00, 4), (Bytes{0x12, 0x20, 0x34, 0x56})) << "they were there all the time";
  EXPECT_EQ(rig.read(0x24, 4), (Bytes{0xFF, 0xE3, 0xFF, 0xFF}));
}

// Table 11-1, the shaded ones.
const std::set<std::uint8_t> take_a_mask{0x0C, 0x0D, 0x0F, 0x1F, 0x2F, 0x3F, 0x4F,
                                         0x5F, 0x6F, 0x7F, 0x28, 0x29, 0x2A, 0x2B,
                                         0x2C, 0x2D, 0x30, 0x40, 0x50, 0x60, 0x70};

TEST(Mcp2515Registers, BitModifyKeepsToItsMaskWhereTheRegisterTakesOne) {
  struct Row {
    const char* name;
    std::uint8_t address;
    std::uint8_t before;
    std::uint8_t mask;
    std::uint8_t value;
    int after;
  };
  constexpr Row rows[] = {
      {"BFPCTRL", 0x0C, 0x0C, 0x30, 0x20, 0x2C},
      {"TXRTSCTRL", 0x0D, 0x01, 0x06, 0x04, 0x05 | 0x10},
      {"CANCTRL", 0x0F, 0x87, 0x03, 0x00, 0x84},
      {"CNF3", 0x28, 0x07, 0x80, 0xFF, 0x87},
      {"CNF2", 0x29, 0xB4, 0x0F, 0x03, 0xB3},
      {"CNF1", 0x2A, 0x3F, 0xC0, 0x55, 0x7F},
      {"CANINTE", 0x2B, 0x1F, 0xA1, 0xA0, 0xBE},
      {"CANINTF: clears one flag and no other", 0x2C, 0x1F, 0x02, 0x00, 0x1D},
      {"EFLG", 0x2D, 0xC0, 0x40, 0x00, 0x80},
      {"TXB0CTRL: a new priority", 0x30, 0x01, 0x03, 0x02, 0x02},
      {"TXB1CTRL: mask of zero changes nothing", 0x40, 0x03, 0x00, 0xFF, 0x03},
      {"TXB2CTRL", 0x50, 0x03, 0x01, 0x00, 0x02},
      {"RXB0CTRL", 0x60, 0x60, 0x04, 0xFF, 0x66},
      {"RXB1CTRL", 0x70, 0x60, 0x60, 0x00, 0x00},
  };
  for (const Row& row : rows) {
    ChipRig rig;
    rig.write(row.address, row.before);
    rig.modify(row.address, row.mask, row.value);
    EXPECT_EQ(rig.read(row.address), row.after) << row.name;
    EXPECT_EQ(rig.violations(), Texts{}) << row.name;
  }
}

TEST(Mcp2515Registers, ElsewhereTheMaskOfBitModifyActsAsFf) {
  int tried = 0;
  for (std::uint8_t address = 0; address < 0x60; ++address) {
    const bool read_only = (address & 0x0F) == 0x0E || address == 0x1C || address == 0x1D;
    if (take_a_mask.count(address) != 0 || read_only) {
      continue;
    }
    ++tried;
    ChipRig rig;
    rig.write(address, 0xFF);
    rig.modify(address, 0x01, 0x00);
    EXPECT_EQ(rig.read(address), 0x00) << int{address} << ": the whole byte was written";
    EXPECT_EQ(rig.violations().size(), 1U) << int{address} << ": and noted";
  }
  EXPECT_EQ(tried, 24 + 8 + 3 * 13) << "filters, masks, transmit buffers";
}

}  // namespace
}  // namespace roio::test
