// Frames are taken back, all or some of them. That what became of each is told truly is in
// transmit_order_test.cpp, which the mutations compile.
#include <algorithm>

#include "sending.hpp"

namespace roio::test {
namespace {

TEST(Abort, EndsAlsoForAProgramThatOnlySends) {
  Rig<> rig;
  rig.begin();
  ASSERT_EQ(rig.can.send(numbered(1), 1), Status::ok);
  rig.can.abort();
  int tries = 0;
  while (rig.can.send(numbered(2), 2) == Status::full && tries < 100) {
    ++tries;
    rig.bus.run_for(microseconds(20));
  }
  EXPECT_LT(tries, 100);
}

TEST(Abort, OfNothingChangesNothing) {
  SendingRig rig;
  rig.begin();
  rig.can.abort();
  EXPECT_EQ(rig.can.send(numbered(1), 1), Status::ok);
  poll_until_idle(rig);
  EXPECT_EQ(numbers_of(rig.peer_received), counting(1, 1));
}

TEST(Abort, FreesANodeThatNobodyAnswers) {
  SendingRig rig;
  rig.begin();
  rig.peer.controller().set_mode(sim::Controller::Mode::off);
  ASSERT_EQ(rig.can.send(numbered(1), 1), Status::ok);
  rig.bus.run_for(milliseconds(100));
  ASSERT_EQ(rig.can.poll(), Status::ok);
  EXPECT_TRUE(rig.can.traits().outcomes.empty()) << "tried again and again";
  rig.can.abort();
  poll_until_idle(rig);
  EXPECT_EQ(rig.can.traits().outcomes, (std::vector<Outcome>{{1, TxOutcome::aborted}}));
}

struct Picky : BackToBack {
  [[nodiscard]] bool is_over(std::uint8_t token) const {
    return std::find(over.begin(), over.end(), token) != over.end();
  }
  std::vector<std::uint8_t> over;
};

TEST(Abort, OfSomeLeavesTheOthersInTheirOrder) {
  Rig<false, 0, queue, Picky> rig;
  rig.begin();
  rig.peer.controller().set_mode(sim::Controller::Mode::off);
  for (std::uint8_t i = 0; i < 6; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i), i), Status::ok);
  }
  ASSERT_EQ(rig.can.send(numbered(6, 4, urgent_to_own), 6), Status::ok);  // 0, 1 and 6 in the chip
  rig.can.traits().over = {0, 3};
  rig.can.abort();
  rig.bus.run_for(milliseconds(1));
  ASSERT_EQ(rig.can.poll(), Status::ok);
  ASSERT_EQ(rig.can.poll(), Status::ok);
  EXPECT_EQ(rig.can.traits().outcomes,
            (std::vector<Outcome>{{3, TxOutcome::aborted}, {0, TxOutcome::aborted}}));
  rig.peer.controller().set_mode(sim::Controller::Mode::normal);
  poll_until_idle(rig);
  EXPECT_EQ(numbers_of(rig.peer_received), (std::vector<std::uint32_t>{6, 1, 2, 4, 5}));
  EXPECT_EQ(rig.can.traits().outcomes.size(), 7U);
  EXPECT_EQ(rig.can.counters().not_sent, 2U);
  EXPECT_EQ(rig.can.counters().sent, 5U);
}

TEST(Abort, OfNoneOfThemTouchesNothing) {
  Rig<false, 0, queue, Picky> rig;
  rig.begin();
  for (std::uint8_t i = 0; i < 5; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i), i), Status::ok);
  }
  rig.can.abort();
  EXPECT_EQ(rig.can.send(numbered(5), 5), Status::ok);
  poll_until_idle(rig);
  EXPECT_EQ(numbers_of(rig.peer_received), counting(0, 6));
}

TEST(Abort, WhatIsToBeSentAgainIsUnknownWhenTheChipIsLostMeanwhile) {
  Rig<false, 0, queue, Picky> rig;
  rig.begin();
  ASSERT_EQ(rig.can.send(numbered(0), 0), Status::ok);
  ASSERT_EQ(rig.can.send(numbered(1), 1), Status::ok);
  rig.bus.run_for(microseconds(50));  // 0 is on the wire, 1 in the chip
  rig.can.traits().over = {0};
  rig.can.abort();
  ASSERT_EQ(rig.can.poll(), Status::ok);  // 1 is back, 0 not yet
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  EXPECT_EQ(rig.can.traits().outcomes,
            (std::vector<Outcome>{{0, TxOutcome::unknown}, {1, TxOutcome::unknown}}));
}

}  // namespace
}  // namespace roio::test
