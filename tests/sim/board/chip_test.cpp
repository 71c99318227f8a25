// A board and its chip: SPI, interrupt line, and frames between two boards (firmware/chip.cpp).
#include <roio/sim/host_node.hpp>

#include "board_rig.hpp"

namespace roio::test {
namespace {

class BoardChip : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, BoardChip, all_boards, board_name);

// 0x123, two bytes: RXB0SIDH, SIDL, EID8, EID0, DLC, data.
const Bytes canstat_and_frame{0x80, 0x24, 0x60, 0x00, 0x00, 0x02, 0xCA, 0xFE};

TEST_P(BoardChip, AnswersAfterReset) {
  BoardRig rig(bus_, GetParam(), "chip");
  bus_.run_for(10ms);
  EXPECT_EQ(rig.sent, Bytes{0x80});
  EXPECT_EQ(rig.board.chip().mode(), sim::Mcp2515Chip::OperationMode::normal);
  EXPECT_EQ(rig.board.chip().bitrate_bps(), 500'000U);
  EXPECT_TRUE(rig.board.violations().empty());
  EXPECT_TRUE(rig.board.chip().violations().empty());
}

TEST_P(BoardChip, TwoBoardsExchangeAFrame) {
  BoardRig receiver(bus_, GetParam(), "chip");
  BoardRig sender(bus_, sim::BoardKind::uno, "chip");
  sender.board.set_pin(4, false);
  int frames = 0;
  bus_.on_frame([&](const Frame& frame, const sim::Controller& /*sender*/) {
    ++frames;
    EXPECT_EQ(frame.id, 0x123U);
  });
  bus_.run_for(10ms);
  EXPECT_EQ(frames, 1);
  EXPECT_EQ(receiver.sent, canstat_and_frame);
  EXPECT_EQ(sender.sent, Bytes{0x80});
}

// From the chip's pin to the first byte of the read: the interrupt's response, its function and the
// loop of the program, and one lead at most.
TEST_P(BoardChip, TheInterruptLineReachesTheProgram) {
  BoardRig rig(bus_, GetParam(), "chip");
  sim::HostNode peer(bus_, 500'000);
  bus_.run_for(10ms);
  sim::SimTime accepted{0};
  sim::SimTime first{0};
  rig.board.chip().on_accepted([&](const Frame& /*frame*/) { accepted = bus_.now(); });
  rig.board.on_spi([&](sim::SimTime time, std::uint8_t out, std::uint8_t /*in*/) {
    if (out == 0x90) {
      first = time;
    }
  });
  peer.send(Frame{0x123, FrameKind::standard, 2, {0xCA, 0xFE}});
  bus_.run_for(1ms);
  EXPECT_EQ(rig.sent, canstat_and_frame);
  EXPECT_GT(first - accepted, cpu_cycles(16 + 20));
  EXPECT_LT(first - accepted, cpu_cycles(16 + 100) + 1us);
  EXPECT_EQ(rig.board.pin(13), true) << "the program has toggled it";
}

TEST_P(BoardChip, AnotherPinForTheInterruptLineReachesNobody) {
  BoardRig rig(bus_, GetParam(), "chip", {.interrupt_pin = std::nullopt});
  sim::HostNode peer(bus_, 500'000);
  bus_.run_for(10ms);
  peer.send(Frame{0x123, FrameKind::standard, 2, {0xCA, 0xFE}});
  bus_.run_for(1ms);
  EXPECT_EQ(rig.sent, Bytes{0x80});
  EXPECT_FALSE(rig.board.chip().interrupt_pin());
}

TEST(BoardOptions, WrongPins) {
  sim::CanBus bus;
  const auto elf = firmware("chip", "atmega328p");
  EXPECT_THROW(sim::Board(bus, sim::BoardKind::uno, elf, {.chip_select_pin = 20}),
               std::invalid_argument);
  EXPECT_THROW(sim::Board(bus, sim::BoardKind::uno, elf, {.interrupt_pin = -1}),
               std::invalid_argument);
}

TEST_P(BoardChip, ResetLeavesTheChipAsItIs) {
  BoardRig rig(bus_, GetParam(), "chip");
  bus_.run_for(10ms);
  rig.board.reset();
  bus_.run_for(1us);
  EXPECT_EQ(rig.board.chip().mode(), sim::Mcp2515Chip::OperationMode::normal);
  EXPECT_EQ(rig.board.chip().events().resets, 3U) << "power-on, and two by the program";
  bus_.run_for(10ms);
  EXPECT_EQ(rig.board.chip().events().resets, 5U);
  EXPECT_EQ(rig.sent, (Bytes{0x80, 0x80}));
  EXPECT_EQ(rig.board.resets(), 1U);
}

TEST_P(BoardChip, EndsBeforeTheBus) {
  sim::HostNode peer(bus_, 500'000);
  {
    BoardRig rig(bus_, GetParam(), "chip");
    bus_.run_for(1ms);
  }
  peer.send(Frame{0x123, FrameKind::standard, 2, {0xCA, 0xFE}});
  bus_.run_for(10ms);
  EXPECT_EQ(peer.waiting(), 1U) << "nobody is left to acknowledge";
}

// Everything that happens on the bus, on the UARTs and on SPI, with its times.
std::vector<std::string> history(sim::SimTime step) {
  sim::CanBus bus;
  std::vector<std::string> lines;
  const auto note = [&](const std::string& what, unsigned a, unsigned b) {
    lines.push_back(std::to_string(bus.now().count()) + " " + what + " " + std::to_string(a) + " " +
                    std::to_string(b));
  };
  BoardRig receiver(bus, sim::BoardKind::mega, "chip");
  BoardRig other(bus, sim::BoardKind::leonardo, "chip");
  BoardRig sender(bus, sim::BoardKind::uno, "chip");
  for (BoardRig* const rig : {&receiver, &other, &sender}) {
    rig->board.on_spi([&note, rig](sim::SimTime /*time*/, std::uint8_t out, std::uint8_t in) {
      note(rig->board.name(), out, in);
    });
  }
  sim::HostNode peer(bus, 500'000);
  peer.on_receive([&](const Frame& frame) { note("frame", frame.id, frame.length); });
  sender.board.set_pin(4, false);
  for (const auto at : {3ms, 4ms, 5ms}) {
    bus.at(at, [&] { peer.send(Frame{0x7F0, FrameKind::standard, 2, {1, 2}}); });
  }
  for (sim::SimTime time{0}; time < 10ms; time += step) {
    bus.run_for(step);
  }
  return lines;
}

TEST(BoardTime, TheSameRunGivesTheSame) {
  const std::vector<std::string> first = history(10ms);
  EXPECT_GT(first.size(), 100U);
  EXPECT_EQ(first, history(10ms));
}

// What a program does by itself is the same however the bus is run; only what comes from outside
// may reach it a lead sooner or later. Here the chips' lines do, a little.
TEST(BoardTime, PiecesOfARunMakeLittleDifference) {
  const std::vector<std::string> whole = history(10ms);
  const std::vector<std::string> pieces = history(10us);
  EXPECT_EQ(whole.size(), pieces.size());
}

TEST_P(BoardChip, TheBoardKeepsStepWithTheBus) {
  BoardRig rig(bus_, GetParam(), "chip");
  for (int i = 0; i < 2000; ++i) {
    bus_.run_for(7us);
    ASSERT_GE(rig.board.now(), bus_.now());
    ASSERT_LE(rig.board.now(), bus_.now() + 1us + cpu_cycles(8));
  }
}

}  // namespace
}  // namespace roio::test
