// The SPI of a board: its times and flags as the program sees them (firmware/spi_times.cpp), and
// the times of the bytes as the chip sees them. Numbers from the ATmega328P's datasheet, 18.5.
#include <map>

#include "board_rig.hpp"

namespace roio::test {
namespace {

class BoardSpi : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, BoardSpi, all_boards, board_name);

TEST_P(BoardSpi, TakesEightClocksOfEachDivider) {
  BoardRig rig(bus_, GetParam(), "spi_times");
  bus_.run_for(50ms);
  const std::vector<int> words = rig.words();
  ASSERT_GE(words.size(), 21U);
  std::size_t at = 0;
  for (const int divider : {2, 4, 8, 16, 32, 64, 128}) {
    SCOPED_TRACE(divider);
    EXPECT_EQ(words[at], 0) << "SPIF one cycle too early";
    EXPECT_EQ(words[at + 1], 1) << "no SPIF in time";
    // Seen by polling: the timer's own instructions and up to one turn of the loop later.
    EXPECT_GE(words[at + 2], 8 * divider);
    EXPECT_LE(words[at + 2], 8 * divider + 12);
    at += 3;
  }
}

TEST_P(BoardSpi, BytesReachTheChipAtThatRate) {
  BoardRig rig(bus_, GetParam(), "spi_times");
  std::vector<sim::SimTime> times;
  rig.board.on_spi([&](sim::SimTime time, std::uint8_t out, std::uint8_t in) {
    EXPECT_EQ(in, 0xFF) << "nobody is selected";
    if (out == 0x55) {
      times.push_back(time);
    }
    EXPECT_EQ(time, bus_.now());
  });
  bus_.run_for(50ms);
  EXPECT_EQ(times.size(), 7U);
}

TEST_P(BoardSpi, Flags) {
  BoardRig rig(bus_, GetParam(), "spi_times");
  bus_.run_for(50ms);
  const std::vector<int> words = rig.words();
  ASSERT_EQ(words.size(), 29U);
  EXPECT_EQ(words[21], 0xC0) << "WCOL and SPIF";
  EXPECT_EQ(words[22], 0x00) << "both cleared by reading SPSR, then SPDR";
  EXPECT_EQ(words[23], 0x80) << "SPDR alone does not clear SPIF";
  EXPECT_EQ(words[24], 0x00);
  EXPECT_EQ(words[25], 1) << "one interrupt";
  EXPECT_EQ(words[26], 0x00) << "which clears SPIF";
  ASSERT_GE(rig.board.violations().size(), 1U);
  EXPECT_EQ(rig.board.violations()[0].what, "SPDR written while a byte is under way");
}

// Ardens pull request 134, measured on an ATmega32U4: cycles from instruction to instruction.
TEST_P(BoardSpi, AByteWrittenOrReadTooEarlyIsWhatItIsOnSilicon) {
  BoardRig rig(bus_, GetParam(), "spi_times");
  Bytes out;
  rig.board.on_spi([&](sim::SimTime, std::uint8_t byte, std::uint8_t) { out.push_back(byte); });
  bus_.run_for(50ms);
  const auto begin = std::find(out.begin(), out.end(), 0xA0);
  ASSERT_NE(begin, out.end());
  const Bytes expected{0xA0,
                       0xA1,        // 16 cycles: the second is lost, and WCOL tells
                       0xA1, 0x00,  // 17: it goes out, as something else
                       0xA1, 0xA2,  // 18
                       0xA3, 0xA4, 0xA3, 0xA4};
  EXPECT_EQ(Bytes(begin, out.end()), expected);
  std::vector<std::pair<std::string, std::uint64_t>> violations;
  for (const auto& violation : rig.board.violations()) {
    violations.emplace_back(violation.what, violation.times);
  }
  // Of those written while a byte is under way, one is Flags'.
  EXPECT_EQ(violations, (std::vector<std::pair<std::string, std::uint64_t>>{
                            {"SPDR written while a byte is under way", 2},
                            {"SPDR written in the cycle after a byte: 0 goes out", 1},
                            {"SPDR read before the byte is there", 1}}))
      << "read after 16 cycles; after 17 it is there";
}

// 8 MHz, and the loop of firmware/board.hpp between two bytes: what a chip sees is 16 cycles of
// transfer, and in between what the program's own instructions take. Exact, and no lead in it.
TEST_P(BoardSpi, TheChipSeesEachByteAtItsTime) {
  BoardRig rig(bus_, GetParam(), "chip");
  std::map<sim::SimTime, std::uint8_t> bytes;
  rig.board.on_spi(
      [&](sim::SimTime time, std::uint8_t out, std::uint8_t /*in*/) { bytes.emplace(time, out); });
  bus_.run_for(3ms);
  ASSERT_GE(bytes.size(), 4U);
  auto byte = bytes.begin();
  EXPECT_EQ((byte++)->second, 0xC0);
  const auto read = byte++;
  const auto address = byte++;
  EXPECT_EQ(read->second, 0x03);
  EXPECT_EQ(address->second, 0x0E);
  const sim::SimTime gap = address->first - read->first;
  EXPECT_EQ(gap % cpu_cycles(1), sim::SimTime(0));
  EXPECT_GE(gap, cpu_cycles(17));
  EXPECT_LE(gap, cpu_cycles(16 + 24));
}

TEST_P(BoardSpi, WithoutAChipReadsOnes) {
  BoardRig rig(bus_, GetParam(), "chip", {.has_chip = false});
  bus_.run_for(3ms);
  EXPECT_EQ(rig.sent, Bytes{0xFF});
  EXPECT_THROW((void)rig.board.chip(), std::logic_error);
}

TEST_P(BoardSpi, WithItsCableOffReadsWhatTheLineIsAt) {
  BoardRig rig(bus_, GetParam(), "chip");
  rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_low);
  bus_.run_for(3ms);
  EXPECT_EQ(rig.sent, Bytes{0x00});
  rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  rig.board.reset();
  bus_.run_for(3ms);
  EXPECT_EQ(rig.sent, (Bytes{0x00, 0xFF}));
  rig.board.set_chip_fault(sim::SpiWire::Fault::none);
  rig.board.reset();
  bus_.run_for(3ms);
  EXPECT_EQ(rig.sent, (Bytes{0x00, 0xFF, 0x80}));
}

TEST_P(BoardSpi, OnAnotherPinTheChipIsNotSelected) {
  BoardRig rig(bus_, GetParam(), "chip", {.chip_select_pin = 8});
  bus_.run_for(3ms);
  EXPECT_EQ(rig.sent, Bytes{0xFF});
}

}  // namespace
}  // namespace roio::test
