// ServoController: three angles move three servos; what is wrong moves none and is counted.
#include <array>

#include "sketch_rig.hpp"

namespace roio::test {
namespace {

constexpr Address arm{0, 2};
constexpr std::array<int, 3> servo_pins{3, 5, 6};
using Angles = std::array<int, 3>;

/// A pulse begins or ends up to 10 us late when the processor is busy just then: about one degree.
constexpr double tolerance = 1.1;

void expect_angles(const sim::Board& board, const Angles& expected) {
  for (std::size_t i = 0; i < servo_pins.size(); ++i) {
    EXPECT_NEAR(board.servo_angle(servo_pins[i]).value_or(-99), expected[i], tolerance)
        << "servo " << i + 1;
  }
}

/// What the arm answers when it is asked how many messages it refused.
std::string refused(unsigned count) {
  return text(frame_of(arm, pc_address,
                       {static_cast<std::uint8_t>(count >> 8), static_cast<std::uint8_t>(count)}));
}

class ServoController : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, ServoController, all_boards, board_name);

TEST_P(ServoController, StartsAt45Degrees) {
  SketchRig rig(GetParam(), "ServoController");
  rig.bus.run_for(100ms);
  expect_angles(rig.board, {45, 45, 45});
}

TEST_P(ServoController, MovesEachServoToItsAngle) {
  SketchRig rig(GetParam(), "ServoController");
  rig.bus.run_for(50ms);
  for (const Angles& row : {Angles{0, 90, 180}, Angles{180, 0, 60}, Angles{120, 177, 3}}) {
    rig.send(arm, Bytes(row.begin(), row.end()));
    EXPECT_EQ(rig.run(50ms), Texts{}) << "an order needs no answer";
    expect_angles(rig.board, row);
  }
  rig.send(arm, {});
  EXPECT_EQ(rig.run(10ms), Texts{refused(0)});
}

TEST_P(ServoController, RefusesBadMessagesAndCountsThem) {
  SketchRig rig(GetParam(), "ServoController");
  rig.bus.run_for(50ms);
  rig.send(arm, {10, 20, 30});
  rig.bus.run_for(50ms);
  const std::vector<Bytes> bad = {
      {90},          {90, 90},      {90, 90, 90, 90}, {90, 90, 90, 90, 90, 90, 90, 90},
      {181, 90, 90}, {90, 181, 90}, {90, 90, 181},    {255, 255, 255},
  };
  for (std::size_t i = 0; i < bad.size(); ++i) {
    SCOPED_TRACE(i);
    rig.send(arm, bad[i]);
    rig.bus.run_for(50ms);
    expect_angles(rig.board, {10, 20, 30});
    rig.send(arm, {});
    EXPECT_EQ(rig.run(5ms), Texts{refused(static_cast<unsigned>(i + 1))});
  }
}

TEST(ServoControllerUno, CountsBeyondAByte) {
  SketchRig rig(sim::BoardKind::uno, "ServoController");
  rig.bus.run_for(50ms);
  for (int i = 0; i < 300; ++i) {
    rig.send(arm, {1});
  }
  rig.bus.run_for(100ms);
  rig.send(arm, {});
  EXPECT_EQ(rig.run(10ms), Texts{refused(300)});
}

TEST(ServoControllerUno, IgnoresBroadcastsAndMessagesToOthers) {
  SketchRig rig(sim::BoardKind::uno, "ServoController");
  rig.bus.run_for(50ms);
  rig.send({0, broadcast_node}, {90, 90, 90});
  rig.send({0, broadcast_node}, {90});
  rig.send({0, broadcast_node}, {});
  rig.send({0, 3}, {90, 90, 90});
  rig.send({1, 2}, {90, 90, 90});
  EXPECT_EQ(rig.run(50ms), Texts{});
  expect_angles(rig.board, {45, 45, 45});
  rig.send(arm, {});
  EXPECT_EQ(rig.run(10ms), Texts{refused(0)});
}

// Two answers wait in the chip for a bus that others keep busy; the third question finds no room.
TEST(ServoControllerUno, CountsAQuestionThatItCannotAnswer) {
  SketchRig rig(sim::BoardKind::uno, "ServoController");
  rig.bus.run_for(50ms);
  for (int i = 0; i < 3; ++i) {
    rig.send(arm, {});
  }
  for (int i = 0; i < 50; ++i) {
    rig.pc.send({0, FrameKind::standard, 8, {}});
  }
  EXPECT_EQ(rig.run(50ms), (Texts{refused(0), refused(0)}));
  rig.send(arm, {});
  EXPECT_EQ(rig.run(10ms), Texts{refused(1)});
}

TEST(ServoControllerUno, PulsesComeEvery20Milliseconds) {
  SketchRig rig(sim::BoardKind::uno, "ServoController");
  std::vector<sim::SimTime> rises;
  rig.board.on_pin(servo_pins[0], [&](sim::SimTime time, bool high) {
    if (high) {
      rises.push_back(time);
    }
  });
  rig.bus.run_for(500ms);
  ASSERT_GE(rises.size(), 20U);
  for (std::size_t i = 1; i < rises.size(); ++i) {
    EXPECT_NEAR(std::chrono::duration<double>(rises[i] - rises[i - 1]).count(), 20e-3, 20e-6);
  }
}

// Pulses while messages keep the processor as busy as the bus can.
TEST(ServoControllerUno, PulsesStayTrueOnABusyBus) {
  SketchRig rig(sim::BoardKind::uno, "ServoController");
  rig.bus.run_for(50ms);
  for (int i = 0; i < 4000; ++i) {
    rig.send(arm, {90, 90, 90});
  }
  rig.bus.run_for(50ms);
  for (int i = 0; i < 400; ++i) {
    rig.bus.run_for(1ms);
    for (const int pin : servo_pins) {
      ASSERT_NEAR(rig.board.servo_angle(pin).value_or(-99), 90, tolerance);
    }
  }
  EXPECT_GT(rig.pc.waiting(), 0U) << "the bus was busy to the end";
  EXPECT_EQ(rig.board.chip().events().overflowed, 0U);
}

TEST(ServoControllerUno, ObeysAgainAfterTheChipWasWithoutPower) {
  SketchRig rig(sim::BoardKind::uno, "ServoController");
  rig.bus.run_for(50ms);
  rig.send(arm, {10, 20, 30});
  rig.bus.run_for(50ms);
  rig.board.chip().power_cycle();
  rig.bus.run_for(50ms);
  expect_angles(rig.board, {10, 20, 30});  // the servos hold on
  rig.send(arm, {90, 91, 92});
  rig.bus.run_for(50ms);
  expect_angles(rig.board, {90, 91, 92});
}

}  // namespace
}  // namespace roio::test
