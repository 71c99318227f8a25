// SensorBoard: tells its values once, then when they change by enough, and forgets no change.
#include <array>

#include "sketch_rig.hpp"

namespace roio::test {
namespace {

constexpr std::array<int, 2> button_pins{4, 5};

class SensorRig : public SketchRig {
 public:
  explicit SensorRig(sim::BoardKind kind = sim::BoardKind::uno) : SketchRig(kind, "SensorBoard") {
    for (int channel = 0; channel < 4; ++channel) {
      set(channel, 100);
    }
  }
  /// Has the board measure 0..255 at A0 (light), A1..A3: the middle of what makes this number.
  void set(int channel, int value) { board.set_analog(channel, (value + 0.5) * 5 / 256); }
  void press(int button) { board.set_pin(button_pins.at(static_cast<std::size_t>(button)), false); }
  void release(int button) { board.release_pin(button_pins.at(static_cast<std::size_t>(button))); }
  /// Past the first message and the buttons' first 200 ms.
  void settle() { ASSERT_EQ(run(300ms), Texts{told(100, 0, 0, 100, 100, 100)}); }

  static std::string told(int light, int click1, int click2, int pot1, int pot2, int pot3) {
    Bytes data;
    for (const int value : {light, click1, click2, pot1, pot2, pot3}) {
      data.push_back(static_cast<std::uint8_t>(value));
    }
    return text(frame_of({0, 3}, pc_address, data));
  }
};

class SensorBoard : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, SensorBoard, all_boards, board_name);

TEST_P(SensorBoard, TellsItsValuesOnceAndThenWhenTheyChange) {
  SensorRig rig(GetParam());
  rig.set(0, 0);
  rig.set(1, 10);
  rig.set(2, 128);
  rig.set(3, 255);
  EXPECT_EQ(rig.run(300ms), Texts{SensorRig::told(0, 0, 0, 10, 128, 255)});
  rig.set(0, 90);
  EXPECT_EQ(rig.run(100ms), Texts{SensorRig::told(90, 0, 0, 10, 128, 255)});
  rig.press(0);
  EXPECT_EQ(rig.run(100ms), Texts{SensorRig::told(90, 1, 0, 10, 128, 255)});
  rig.press(1);
  EXPECT_EQ(rig.run(100ms), Texts{SensorRig::told(90, 1, 1, 10, 128, 255)});
}

struct Step {
  const char* what;
  int channel;
  int value;
  std::vector<int> told;  // light, pots; empty: nothing
};

TEST(SensorBoardUno, TellsFromTheStepsOn) {
  SensorRig rig;
  rig.settle();
  const Step steps[] = {
      {"light, 5 more", 0, 105, {}},
      {"light, 6 more", 0, 106, {106, 100, 100, 100}},
      {"light, 5 less than told last", 0, 101, {}},
      {"light, 6 less", 0, 100, {100, 100, 100, 100}},
      {"pot 1, 1 more", 1, 101, {}},
      {"pot 1, 2 more", 1, 102, {100, 102, 100, 100}},
      {"pot 1, 1 less", 1, 101, {}},
      {"pot 1, 2 less", 1, 100, {100, 100, 100, 100}},
      {"pot 2, 1 more", 2, 101, {}},
      {"pot 2, 2 more", 2, 102, {100, 100, 102, 100}},
      {"pot 3, 1 less", 3, 99, {}},
      {"pot 3, 2 less, and pot 2 is told as it is", 3, 98, {100, 100, 102, 98}},
      {"light, to the end", 0, 255, {255, 100, 102, 98}},
      {"light, from one end to the other", 0, 0, {0, 100, 102, 98}},
  };
  for (const Step& step : steps) {
    SCOPED_TRACE(step.what);
    rig.set(step.channel, step.value);
    const Texts expected =
        step.told.empty()
            ? Texts{}
            : Texts{SensorRig::told(step.told[0], 0, 0, step.told[1], step.told[2], step.told[3])};
    EXPECT_EQ(rig.run(20ms), expected);
  }
}

TEST(SensorBoardUno, SmallStepsAddUp) {
  SensorRig rig;
  rig.settle();
  for (int value = 101; value <= 105; ++value) {
    rig.set(0, value);
    EXPECT_EQ(rig.run(20ms), Texts{}) << value;
  }
  rig.set(0, 106);
  EXPECT_EQ(rig.run(20ms), Texts{SensorRig::told(106, 0, 0, 100, 100, 100)});
}

// The sketch looks at its buttons about every half millisecond.
TEST(SensorBoardUno, AClickCountsAfter200MillisecondsWithoutOne) {
  SensorRig rig;
  rig.settle();
  rig.press(0);
  EXPECT_EQ(rig.run(500ms), Texts{SensorRig::told(100, 1, 0, 100, 100, 100)}) << "held: once";
  rig.release(0);
  EXPECT_EQ(rig.run(197ms), Texts{});
  rig.press(0);
  EXPECT_EQ(rig.run(100ms), Texts{}) << "after 197 ms";
  rig.release(0);
  EXPECT_EQ(rig.run(202ms), Texts{});
  rig.press(0);
  EXPECT_EQ(rig.run(10ms), Texts{SensorRig::told(100, 2, 0, 100, 100, 100)}) << "after 202 ms";
}

TEST(SensorBoardUno, ContactsThatBounceCountOnce) {
  SensorRig rig;
  rig.settle();
  const auto bounce = [&](bool ends_pressed) {
    for (int i = 0; i < 8; ++i) {
      rig.press(1);
      rig.bus.run_for(1500us);
      rig.release(1);
      rig.bus.run_for(1500us);
    }
    if (ends_pressed) {
      rig.press(1);
    }
  };
  rig.received.clear();
  bounce(true);
  rig.bus.run_for(600ms);
  bounce(false);
  rig.bus.run_for(600ms);
  EXPECT_EQ(rig.received, Texts{SensorRig::told(100, 0, 1, 100, 100, 100)});
}

// Nobody acknowledges, so what is sent stays in the chip, which is full soon. A button is pressed
// and released meanwhile.
TEST(SensorBoardUno, ForgetsNoChangeWhileTheBusIsFull) {
  SensorRig rig;
  rig.settle();
  rig.pc.controller().set_mode(sim::Controller::Mode::off);
  for (const int value : {110, 120, 130, 140}) {
    rig.set(1, value);
    rig.bus.run_for(50ms);
  }
  rig.press(0);
  rig.bus.run_for(50ms);
  rig.release(0);
  rig.set(1, 150);
  rig.bus.run_for(50ms);
  rig.pc.controller().set_mode(sim::Controller::Mode::normal);
  const Texts late = rig.run(100ms);
  ASSERT_GE(late.size(), 2U);
  EXPECT_EQ(late.front(), SensorRig::told(100, 0, 0, 110, 100, 100));
  EXPECT_EQ(late.back(), SensorRig::told(100, 1, 0, 150, 100, 100));
  EXPECT_EQ(rig.run(100ms), Texts{});
}

TEST(SensorBoardUno, TellsAllAgainAfterTheChipWasWithoutPower) {
  SensorRig rig;
  rig.settle();
  rig.board.chip().power_cycle();
  EXPECT_EQ(rig.run(100ms), Texts{SensorRig::told(100, 0, 0, 100, 100, 100)});
}

TEST(SensorBoardUno, DoesNotMindMessagesToIt) {
  SensorRig rig;
  rig.settle();
  for (int i = 0; i < 20; ++i) {
    rig.send({0, 3}, {1, 2, 3});
  }
  rig.set(0, 0);
  EXPECT_EQ(rig.run(100ms), Texts{SensorRig::told(0, 0, 0, 100, 100, 100)});
}

}  // namespace
}  // namespace roio::test
