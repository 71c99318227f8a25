// An urgent message is on the wire ahead of ten normal ones that were queued before it.
#include <gtest/gtest.h>

#include "rig.hpp"

namespace roio::load {
namespace {

constexpr int taken_pin = 5;
constexpr int refused_pin = 6;
constexpr int urgent = 255;

struct Rig {
  Rig() : pc(bus, echo_bps), board(bus, sim::BoardKind::uno, image("Urgent")) {
    pc.on_receive([this](const Frame& frame) { order.push_back(frame.data[0]); });
    board.on_pin(taken_pin, [this](sim::SimTime, bool high) {
      if (high) {
        sent_before = order.size();
      }
    });
    bus.run_for(start_up);
  }

  sim::CanBus bus;
  sim::HostNode pc;
  sim::Board board;
  std::vector<int> order;
  std::size_t sent_before =
      1000;  // how many were on the bus when send() of the urgent one returned
};

// The trigger is followed by frames that win the bus from everybody, for 5 ms.
TEST(Urgent, IsFirstWhenNoneWasOnTheWireYet) {
  Rig rig;
  rig.pc.send(frame_of(pc_address, echo_address, {1}));
  rig.bus.after(100us, [&] {
    for (int i = 0; i < 22; ++i) {
      rig.pc.send(Frame{0, FrameKind::standard, 8, {}});
    }
  });
  rig.bus.run_for(4ms);
  EXPECT_EQ(rig.sent_before, 0U);
  rig.bus.run_for(20ms);
  EXPECT_EQ(rig.order, (std::vector{urgent, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(rig.board.pin(refused_pin), false);
}

TEST(Urgent, IsNextWhenOneIsOnTheWire) {
  Rig rig;
  rig.pc.send(frame_of(pc_address, echo_address, {1}));
  rig.bus.run_for(20ms);
  std::vector<int> expected{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  ASSERT_LT(rig.sent_before, 5U) << "some still waited when it was given";
  // One may have been on its way at that moment.
  ASSERT_EQ(rig.order.size(), 11U);
  const bool one_under_way = rig.order[rig.sent_before] != urgent;
  expected.insert(expected.begin() + static_cast<std::ptrdiff_t>(rig.sent_before) + one_under_way,
                  urgent);
  EXPECT_EQ(rig.order, expected);
  EXPECT_EQ(rig.board.pin(refused_pin), false);
}

}  // namespace
}  // namespace roio::load
