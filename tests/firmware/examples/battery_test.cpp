// Battery: sleeps when there is nothing to do, and wakes when the bus stirs.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

using ChipMode = sim::Mcp2515Chip::OperationMode;
constexpr Address node{0, 6};

/// With a third node, so that there is always one that acknowledges.
struct BatteryRig : SketchRig {
  explicit BatteryRig(sim::BoardKind kind, const sim::BoardOptions& options = {})
      : SketchRig(kind, "Battery", options) {}
  sim::HostNode other{bus, bitrate_bps};
};

class BatteryOnEachBoard : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, BatteryOnEachBoard, all_boards, board_name);

TEST_P(BatteryOnEachBoard, SleepsAndTheBusWakesIt) {
  BatteryRig rig(GetParam());
  rig.bus.run_for(500ms);
  rig.send(node, {1});
  EXPECT_EQ(rig.run(100ms), Texts{"0.6 > 0.10: 00 00"}) << "awake at first";
  rig.bus.run_for(3s);
  EXPECT_EQ(rig.board.chip().mode(), ChipMode::sleep);
  EXPECT_EQ(rig.board.state(), sim::Board::State::sleeping);
  rig.send(node, {2});
  EXPECT_EQ(rig.run(100ms), Texts{}) << "the message that wakes the chip is lost";
  EXPECT_EQ(rig.board.chip().mode(), ChipMode::normal);
  rig.send(node, {3});
  EXPECT_EQ(rig.run(100ms), Texts{"0.6 > 0.10: 00 01"});
  rig.bus.run_for(3s);
  EXPECT_EQ(rig.board.chip().mode(), ChipMode::sleep) << "and again";
  EXPECT_TRUE(rig.board.chip().violations().empty()) << rig.board.chip().violations().front().what;
}

TEST(Battery, WithOneOtherNodeLosesNothingForThatRepeatsUntilSomebodyAcknowledges) {
  SketchRig rig(sim::BoardKind::uno, "Battery");
  rig.bus.run_for(3s);
  ASSERT_EQ(rig.board.chip().mode(), ChipMode::sleep);
  rig.send(node, {1});
  const Texts answers = rig.run(100ms);
  EXPECT_EQ(rig.pc.waiting(), 0U);
  ASSERT_FALSE(answers.empty());
  EXPECT_EQ(answers, Texts(answers.size(), "0.6 > 0.10: 00 01"));
}

TEST(Battery, WithoutIntStaysAwake) {
  sim::BoardOptions options;
  options.interrupt_pin = std::nullopt;
  BatteryRig rig(sim::BoardKind::uno, options);
  rig.bus.run_for(3s);
  EXPECT_EQ(rig.board.chip().mode(), ChipMode::normal);
  rig.send(node, {1});
  EXPECT_EQ(rig.run(100ms), Texts{"0.6 > 0.10: 00 00"});
}

}  // namespace
}  // namespace roio::test
