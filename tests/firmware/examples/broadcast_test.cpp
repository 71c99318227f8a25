// Broadcast: sends to everybody every second, and prints what others send to everybody.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

class Broadcast : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, Broadcast, all_boards, board_name);

TEST_P(Broadcast, SendsACountEverySecond) {
  SketchRig rig(GetParam(), "Broadcast");
  EXPECT_EQ(rig.run(3500ms), (Texts{"0.4 > 0.*: 00", "0.4 > 0.*: 01", "0.4 > 0.*: 02"}));
  ASSERT_EQ(rig.received_at.size(), 3U);
  for (int i = 1; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(
        std::chrono::duration<double>(rig.received_at[at] - rig.received_at[at - 1]).count(), 1.0,
        0.003);
  }
}

TEST(BroadcastUno, PrintsOthersBroadcastsAndNothingElse) {
  SketchRig rig(sim::BoardKind::uno, "Broadcast");
  EXPECT_EQ(rig.run_for_lines(50ms), Texts{"This is 0.4"});
  const Address everybody{0, broadcast_node};
  const struct {
    Frame frame;
    Texts printed;
  } rows[] = {
      {frame_of({0, 5}, everybody, {12}), {"0.5 says 12"}},
      {frame_of({31, 254}, everybody, {0, 255, 7}, Priority::urgent), {"31.254 says 0 255 7"}},
      {frame_of({0, 5}, everybody, {}), {"0.5 says"}},
      {frame_of({0, 5}, {0, 4}, {1}), {}},
      {frame_of({0, 5}, {1, broadcast_node}, {2}), {}},
  };
  for (const auto& row : rows) {
    rig.pc.send(row.frame);
    EXPECT_EQ(rig.run_for_lines(10ms), row.printed) << text(row.frame);
  }
}

TEST(BroadcastMega, PrintsToo) {
  SketchRig rig(sim::BoardKind::mega, "Broadcast");
  rig.bus.run_for(50ms);
  rig.pc.send(frame_of({0, 5}, {0, broadcast_node}, {12}));
  rig.bus.run_for(50ms);
  EXPECT_EQ(rig.lines, (Texts{"This is 0.4", "0.5 says 12"}));
}

// A full line takes 5 ms to print, ten times as long as a message on the bus.
TEST(BroadcastUno, SaysWhenMessagesCameTooFast) {
  SketchRig rig(sim::BoardKind::uno, "Broadcast");
  rig.bus.run_for(50ms);
  for (std::uint8_t i = 0; i < 100; ++i) {
    rig.pc.send(frame_of({0, 5}, {0, broadcast_node}, Bytes(8, 200)));
  }
  const Texts lines = rig.run_for_lines(500ms);
  const auto said = static_cast<std::size_t>(
      std::count(lines.begin(), lines.end(), "0.5 says 200 200 200 200 200 200 200 200"));
  const auto told = static_cast<std::size_t>(std::count_if(
      lines.begin(), lines.end(),
      [](const std::string& line) { return line.starts_with("Messages came too fast, times: "); }));
  EXPECT_EQ(said + told, lines.size());
  EXPECT_GT(said, 2U);
  EXPECT_LT(said, 100U);
  EXPECT_GT(told, 0U);
  EXPECT_EQ(rig.board.chip().events().overflowed, 100 - said);
}

TEST(BroadcastUno, SaysThatThereIsNoChipAndBeginsWhenThereIs) {
  SketchRig rig(sim::BoardKind::uno, "Broadcast");
  rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  EXPECT_EQ(rig.run_for_lines(500ms),
            (Texts{"This is 0.4",
                   "Cannot begin, no controller answers: check the wiring and the CS pin"}));
  rig.board.set_chip_fault(sim::SpiWire::Fault::none);
  rig.received.clear();
  rig.bus.run_for(1s);
  EXPECT_EQ(rig.received, Texts{"0.4 > 0.*: 00"});
}

// What was not sent for want of somebody who acknowledges comes once there is one, in order.
TEST(BroadcastUno, SaysThatTheBusIsStuck) {
  SketchRig rig(sim::BoardKind::uno, "Broadcast");
  rig.bus.hold_dominant(true);
  EXPECT_EQ(
      rig.run_for_lines(500ms),
      (Texts{"This is 0.4",
             "Cannot begin, controller not in the mode asked for: check the wiring and the CS "
             "pin"}));
}

TEST(BroadcastUno, LosesNoCountWhileAlone) {
  SketchRig rig(sim::BoardKind::uno, "Broadcast");
  rig.pc.controller().set_mode(sim::Controller::Mode::off);
  rig.bus.run_for(4500ms);
  rig.pc.controller().set_mode(sim::Controller::Mode::normal);
  rig.bus.run_for(1500ms);
  ASSERT_GE(rig.received.size(), 3U);
  for (std::size_t i = 0; i < rig.received.size(); ++i) {
    EXPECT_EQ(rig.received[i],
              text(frame_of({0, 4}, {0, broadcast_node}, {static_cast<std::uint8_t>(i)})));
  }
}

}  // namespace
}  // namespace roio::test
