// The UART of a board (firmware/uart.cpp): times as the ATmega328P's datasheet has them, 19.
#include <numeric>

#include "board_rig.hpp"

namespace roio::test {
namespace {

class BoardUart : public EachBoard {
 protected:
  BoardUart() { bus_.run_for(1ms); }
  BoardRig rig_{bus_, GetParam(), "uart"};
};
INSTANTIATE_TEST_SUITE_P(, BoardUart, all_boards, board_name);

Bytes row_of(int count, int first) {
  Bytes result(static_cast<std::size_t>(count));
  std::iota(result.begin(), result.end(), static_cast<std::uint8_t>(first));
  return result;
}

TEST_P(BoardUart, AByteTakesTenBits) {
  const struct {
    const char* name;
    std::uint8_t ubrr_high;
    std::uint8_t ubrr;
    std::uint8_t u2x;
    int bit;  // cycles
  } rows[] = {
      {"2 Mbit/s", 0, 0, 1, 8},           {"1 Mbit/s", 0, 1, 1, 16},
      {"1 Mbit/s, U2X off", 0, 0, 0, 16}, {"500 kbit/s", 0, 3, 1, 32},
      {"115200", 0, 16, 1, 136},          {"57600", 0, 34, 1, 280},
      {"9600, U2X off", 0, 103, 0, 1664}, {"2400", 3, 0x41, 1, 6664 + 8},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    sim::CanBus bus;
    BoardRig rig(bus, GetParam(), "uart");
    bus.run_for(1ms);
    rig.write({'r', row.ubrr_high, row.ubrr, row.u2x});
    bus.run_for(1ms);
    EXPECT_DOUBLE_EQ(rig.board.serial_bitrate_bps(rig.uart).value(), 16e6 / row.bit);
    rig.write({'t'});
    bus.run_for(100ms);
    EXPECT_EQ(rig.sent, row_of(16, 0x30));
    for (std::size_t i = 1; i < rig.sent_at.size(); ++i) {
      // Double-buffered: not a cycle in between, as long as the program keeps up.
      EXPECT_EQ(rig.sent_at[i] - rig.sent_at[i - 1], cpu_cycles(10 * row.bit)) << i;
    }
  }
}

// TXC comes with the end of the last byte, not with the last write.
TEST_P(BoardUart, ItIsDoneWhenTheLastBitIs) {
  sim::SimTime done{0};
  rig_.board.on_pin(13, [&](sim::SimTime time, bool /*high*/) { done = time; });
  rig_.write({'t'});
  bus_.run_for(10ms);
  ASSERT_EQ(rig_.sent.size(), 16U);
  EXPECT_GE(done, rig_.sent_at.back());
  EXPECT_LE(done, rig_.sent_at.back() + cpu_cycles(12));
}

TEST_P(BoardUart, WhatIsWrittenArrivesInOrderAtTheProgramsRate) {
  const Bytes bytes = row_of(200, 1);
  rig_.write({'e'});
  rig_.write(bytes);
  EXPECT_EQ(rig_.board.serial_waiting(rig_.uart), 201U);
  const sim::SimTime begin = bus_.now();
  bus_.run_for(10ms);
  EXPECT_EQ(rig_.sent, bytes);
  EXPECT_EQ(rig_.board.serial_waiting(rig_.uart), 0U);
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).received, 201U);
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).sent, 200U);
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).overruns, 0U);
  // 201 bytes in, and the last one out again, of 160 cycles each.
  const sim::SimTime taken = rig_.sent_at.back() - begin;
  EXPECT_GE(taken, cpu_cycles(201 * 160 + 160 - 8));
  EXPECT_LE(taken, cpu_cycles(201 * 160 + 160 + 64));
}

TEST_P(BoardUart, InterruptsDoTheSame) {
  Bytes bytes = row_of(200, 1);
  bytes.push_back(0);
  rig_.write({'i'});
  rig_.write(bytes);
  bus_.run_for(10ms);
  EXPECT_EQ(rig_.sent, bytes);
  rig_.write({'?'});
  bus_.run_for(1ms);
  EXPECT_EQ(rig_.sent.back(), '?') << "and it goes on";
}

TEST_P(BoardUart, ThreeBytesFit) {
  rig_.write({'s', 1, 'a', 'b', 'c'});
  bus_.run_for(10ms);
  EXPECT_EQ(rig_.sent, (Bytes{0x80, 'a', 0x80, 'b', 0x80, 'c'}));
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).overruns, 0U);
}

TEST_P(BoardUart, AFourthIsAnOverrunAndDorTells) {
  rig_.write({'s', 1, 'a', 'b', 'c', 'd', 'e'});
  bus_.run_for(10ms);
  EXPECT_EQ(rig_.sent, (Bytes{0x80, 'a', 0x80, 'b', 0x88, 'e'}));
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).overruns, 2U);
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).received, 5U);
}

TEST_P(BoardUart, WhatComesBeforeTheReceiverIsOnIsCounted) {
  rig_.board.reset();
  rig_.write({'x'});
  bus_.run_for(1ms);
  EXPECT_EQ(rig_.board.serial_counters(rig_.uart).unheard, 1U);
  EXPECT_TRUE(rig_.sent.empty());
}

TEST(BoardUarts, WhichThereAre) {
  sim::CanBus bus;
  const struct {
    sim::BoardKind kind;
    std::vector<int> uarts;
  } rows[] = {{sim::BoardKind::uno, {0}},
              {sim::BoardKind::leonardo, {0, 1}},  // 0 is USB
              {sim::BoardKind::mega, {0, 1, 2, 3}}};
  for (const auto& row : rows) {
    sim::Board board(bus, row.kind, firmware("idle", sim::mcu_of(row.kind)));
    std::vector<int> found;
    for (int uart = -1; uart < 5; ++uart) {
      try {
        EXPECT_EQ(board.serial_waiting(uart), 0U);
        found.push_back(uart);
      } catch (const std::invalid_argument&) {  // NOLINT(bugprone-empty-catch)
      }
    }
    EXPECT_EQ(found, row.uarts) << sim::to_string(row.kind);
  }
}

}  // namespace
}  // namespace roio::test
