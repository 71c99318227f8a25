// The bridge on a board whose line is USB: that has flow control, so a PC may take nothing.
#include "bridge_rig.hpp"

namespace roio::test {
namespace {

class OverUsb : public testing::Test {
 protected:
  void SetUp() override { rig.hello(); }

  /// On a full bus; the PC polls as one does.
  void run(std::chrono::milliseconds span) {
    rig.node.on_sent([this](const Frame&) { give(); });
    give();
    give();
    for (std::chrono::milliseconds at{0}; at < span; at += 100ms) {
      rig.poll();
      rig.bus.run_for(100ms);
    }
    rig.node.on_sent(nullptr);
    rig.bus.run_for(50ms);
  }
  void give() {
    rig.node.send(extended(0x10000000 | sent, Bytes(sent % 9, 0x55)));
    ++sent;
  }

  BridgeRig rig{sim::BoardKind::leonardo};
  std::uint32_t sent = 0;
};

TEST_F(OverUsb, APcThatTakesNothingHoldsUpNothing) {
  const auto overflowed_before = rig.board.chip().events().overflowed;
  rig.board.serial_hold(0, true);
  run(3s);
  EXPECT_EQ(rig.board.chip().events().overflowed, overflowed_before)
      << "the bus does not wait for the PC";
  rig.board.serial_hold(0, false);
  run(100ms);
  const std::size_t received = rig.frames().size();
  EXPECT_LT(received, sent / 2);
  EXPECT_GT(received, 400U) << "and goes on";
  EXPECT_EQ(rig.damaged, 0);
  EXPECT_EQ(rig.counter(dropped_counter), sent - received);
}

TEST_F(OverUsb, APcThatTakesNothingNowAndThenHoldsUpNothing) {
  // For long enough that packets fill up, and as little as lets one through.
  const auto overflowed_before = rig.board.chip().events().overflowed;
  rig.node.on_sent([this](const Frame&) { give(); });
  give();
  give();
  for (int i = 0; i < 40; ++i) {
    rig.poll();
    rig.board.serial_hold(0, true);
    rig.bus.run_for(20ms);
    rig.board.serial_hold(0, false);
    rig.bus.run_for(60us * (1 + i % 12));
  }
  EXPECT_EQ(rig.board.chip().events().overflowed, overflowed_before);
}

TEST_F(OverUsb, NoRecordIsHeldBack) {
  // A PC hands on what has come when a packet is not full, or after two: packets of 64 bytes and no
  // more would wait.
  for (int i = 0; i < 200; ++i) {
    Frame frame = extended(0x10000000 + static_cast<std::uint32_t>(i));
    frame.length = static_cast<std::uint8_t>(i % 9);
    rig.poll();
    const std::size_t before = rig.frames().size();
    for (int count = 0; count < 3; ++count) {
      rig.node.send(frame);
    }
    rig.bus.run_for(3ms);
    ASSERT_EQ(rig.frames().size(), before + 3) << i;
  }
}

TEST_F(OverUsb, ANewSessionIsNotEndedByTheByeOfTheOneBefore) {
  rig.board.serial_hold(0, true);  // so that the answer to BYE cannot leave
  for (int i = 0; i < 10; ++i) {
    give();
  }
  rig.bus.run_for(10ms);
  rig.say(serial::Down::bye, {1});
  rig.bus.run_for(50ms);
  rig.board.serial_hold(0, false);
  EXPECT_EQ(rig.hello(session_number + 1).size(), 31U);
  EXPECT_FALSE(rig.ask_status().empty());
}

TEST_F(OverUsb, AResetIsSetUpAnew) {
  rig.board.reset();
  rig.bus.run_for(100ms);
  EXPECT_EQ(rig.hello(session_number + 1).size(), 31U);
  run(100ms);
  EXPECT_EQ(rig.frames().size(), sent);
}

}  // namespace
}  // namespace roio::test
