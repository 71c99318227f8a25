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
  constexpr int dropped = 0;
  EXPECT_EQ(rig.counter(dropped), sent - received);
}

TEST_F(OverUsb, ARecordThatFillsAPacketIsNotHeldBack) {
  // Of all lengths, so that packets of 64 bytes come about; each is there within 3 ms.
  for (int i = 0; i < 200; ++i) {
    Frame frame = extended(0x10000000 + static_cast<std::uint32_t>(i));
    frame.length = static_cast<std::uint8_t>(i % 9);
    rig.poll();
    const std::size_t before = rig.frames().size();
    rig.node.send(frame);
    rig.node.send(frame);
    rig.node.send(frame);
    rig.bus.run_for(4ms);
    ASSERT_EQ(rig.frames().size(), before + 3) << i;
  }
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
