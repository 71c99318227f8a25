// What a frame costs on SPI, in bytes and transactions: the promise of mcp2515.hpp.
#include "rig.hpp"

namespace roio::test {
namespace {

using Cost = std::pair<std::uint64_t, std::uint64_t>;

template <bool WithLine>
Cost cost_of_receiving(std::uint8_t length) {
  Rig<WithLine> rig;
  rig.begin();
  rig.peer_sends({numbered(1, length)});
  rig.mark();
  Frame frame{};
  EXPECT_EQ(rig.can.receive(frame), Status::ok);
  EXPECT_EQ(frame, numbered(1, length));
  return rig.spent();
}

TEST(SpiBudget, TheFirstFrameFoundByPolling) {
  for (std::uint8_t length = 0; length <= 8; ++length) {
    EXPECT_EQ(cost_of_receiving<false>(length), Cost(18 - 8 + length, 3)) << int{length};
  }
}

TEST(SpiBudget, AFrameFoundByTheInterruptLine) {
  for (std::uint8_t length = 0; length <= 8; ++length) {
    EXPECT_EQ(cost_of_receiving<true>(length), Cost(16 - 8 + length, 2)) << int{length};
  }
}

/// Each frame comes in while the one before it is read: the chip is never seen empty.
template <bool WithLine>
void expect_cost_in_a_run(std::uint8_t length) {
  constexpr std::uint32_t run = 40;  // shorter than the 64 calls after which the chip is checked
  Rig<WithLine> rig;
  rig.begin();
  std::uint32_t next = 0;
  bool comes_next = false;
  rig.wire.on_step([&] {
    if (std::exchange(comes_next, false)) {
      rig.chip.receive(numbered(next++, length));
    }
  });
  rig.chip.receive(numbered(next++, length));
  for (std::uint32_t i = 0; i <= run; ++i) {
    if (i == 1) {
      rig.mark();  // the first one was found by looking
    }
    comes_next = true;
    Frame frame{};
    ASSERT_EQ(rig.can.receive(frame), Status::ok);
    ASSERT_EQ(frame, numbered(i, length));
  }
  EXPECT_EQ(rig.spent(), Cost((16U - 8U + length) * run, 2U * run));
}

TEST(SpiBudget, EachFrameOfARun) {
  for (std::uint8_t length = 0; length <= 8; ++length) {
    SCOPED_TRACE(int{length});
    expect_cost_in_a_run<false>(length);
    expect_cost_in_a_run<true>(length);
  }
}

TEST(SpiBudget, BothBuffersFull) {
  Rig<> rig;
  rig.begin();
  rig.peer_sends({numbered(1, 8), numbered(2, 8)});
  rig.mark();
  Frame frame{};
  ASSERT_EQ(rig.can.receive(frame), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(18, 3));
  ASSERT_EQ(rig.can.receive(frame), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(18 + 16 + 9, 3 + 2 + 3)) << "and a look at the error flags";
}

TEST(SpiBudget, NothingThere) {
  Rig<false> polled;
  polled.begin();
  Frame frame{};
  EXPECT_EQ(polled.can.receive(frame), Status::empty);
  EXPECT_EQ(polled.spent(), Cost(2, 1));
  Rig<true> interrupted;
  interrupted.begin();
  EXPECT_EQ(interrupted.can.receive(frame), Status::empty);
  EXPECT_EQ(interrupted.spent(), Cost(0, 0));
}

TEST(SpiBudget, SendingOneFrame) {
  for (const std::uint32_t id : {to_own, urgent_to_own}) {
    for (std::uint8_t length = 0; length <= 8; ++length) {
      Rig<> rig;
      rig.begin();
      for (int i = 0; i < 3; ++i) {
        rig.mark();
        ASSERT_EQ(rig.can.send(numbered(1, length, id)), Status::ok);
        EXPECT_EQ(rig.spent(), Cost(15 - 8 + length, 2)) << int{length};
        rig.bus.run_for(milliseconds(1));
        ASSERT_EQ(rig.can.poll(), Status::ok);
      }
    }
  }
}

TEST(SpiBudget, SendingFramesThatFollowOneAnother) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.send(numbered(1, 8)), Status::ok);
  ASSERT_EQ(rig.can.send(numbered(2, 8)), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(15 + 17, 2 + 3)) << "the second looks whether there is room";
  rig.bus.run_for(microseconds(350));  // the first has gone, the second is on the wire
  ASSERT_EQ(rig.can.poll(), Status::ok);
  rig.mark();
  EXPECT_EQ(rig.can.send(numbered(3, 8)), Status::full);
  EXPECT_EQ(rig.spent(), Cost(2, 1)) << "full until the second has gone, too";
}

TEST(SpiBudget, BackToBackTwoBytesMoreForTheBuffersPriority) {
  Rig<false, 0, 0, BackToBack> rig;
  rig.begin();
  ASSERT_EQ(rig.can.send(numbered(1, 8)), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(17, 2));
  rig.mark();
  ASSERT_EQ(rig.can.send(numbered(2, 8)), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(2 + 17, 1 + 2));
  rig.bus.run_for(microseconds(350));  // the first has gone, the second is on the wire
  ASSERT_EQ(rig.can.poll(), Status::ok);
  rig.mark();
  EXPECT_EQ(rig.can.send(numbered(3, 8)), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(2 + 17, 1 + 2));
}

TEST(SpiBudget, SendingAsksTheChipOnlyWhenItMayBeFull) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.send(numbered(1, 8)), Status::ok);
  ASSERT_EQ(rig.can.send(numbered(2, 8)), Status::ok);
  rig.mark();
  EXPECT_EQ(rig.can.send(numbered(3, 8)), Status::full);
  EXPECT_EQ(rig.spent(), Cost(2, 1));
  rig.bus.run_for(milliseconds(2));
  rig.mark();
  EXPECT_EQ(rig.can.send(numbered(3, 8)), Status::ok);
  EXPECT_EQ(rig.spent(), Cost(2 + 15, 3)) << "one status read, where the answer is needed";
}

TEST(SpiBudget, TheChipIsCheckedEverySixtyFourCalls) {
  Rig<true> rig;
  rig.begin();
  for (int i = 0; i < 640; ++i) {
    ASSERT_EQ(rig.can.poll(), Status::ok);
  }
  EXPECT_EQ(rig.spent(), Cost(10 * (2 + 9), 10 * (1 + 3))) << "the status, and three registers";
}

}  // namespace
}  // namespace roio::test
