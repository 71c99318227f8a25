// An interrupt line that is off makes a node slower, never deaf: each frame is handed out, and it
// is told. And one that works is never taken for one that is off.
#include <functional>
#include <random>

#include "rig.hpp"
#include "seed.hpp"

namespace roio::test {
namespace {

using LineRig = Rig<true>;

/// A program that calls often, as a loop() does.
std::vector<Frame> receive_for(LineRig& rig, sim::SimTime span) {
  std::vector<Frame> received;
  for (const sim::SimTime end = rig.bus.now() + span; rig.bus.now() < end;) {
    for (const Frame& frame : rig.receive_all()) {
      received.push_back(frame);
    }
    rig.bus.run_for(microseconds(2));
  }
  return received;
}

std::vector<Frame> twenty() {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 20; ++i) {
    frames.push_back(numbered(i, 8));
  }
  return frames;
}

void expect_twenty_are_received(LineRig& rig) {
  for (const Frame& frame : twenty()) {
    rig.peer.send(frame);
  }
  EXPECT_EQ(receive_for(rig, milliseconds(20)), twenty());
  EXPECT_EQ(rig.can.counters().received, 20U);
  EXPECT_EQ(rig.can.counters().foreign, 0U);
  EXPECT_EQ(rig.can.counters().discarded, 0U);
  EXPECT_EQ(rig.can.counters().overflows, 0U);
  EXPECT_EQ(rig.can.counters().chip_losses, 0U);
}

struct Fault {
  const char* name;
  std::function<void(sim::SpiWire&, bool)> set;
  bool notices_later;  // when it comes while the driver runs
};
void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}
const Fault faults[] = {
    {"NotConnected", [](sim::SpiWire& wire, bool on) { wire.cut_interrupt_line(on); }, true},
    {"StuckLow", [](sim::SpiWire& wire, bool on) { wire.hold_interrupt_line_low(on); }, false},
};

class InterruptLineOff : public testing::TestWithParam<Fault> {};
INSTANTIATE_TEST_SUITE_P(, InterruptLineOff, testing::ValuesIn(faults),
                         [](const auto& row) { return row.param.name; });

TEST_P(InterruptLineOff, FromTheBeginning) {
  LineRig rig;
  GetParam().set(rig.wire, true);
  rig.begin();
  EXPECT_FALSE(rig.can.line_is_on());
  EXPECT_EQ(rig.can.counters().line_losses, 1U);
  expect_twenty_are_received(rig);
  EXPECT_EQ(rig.can.counters().line_losses, 1U) << "once";
}

TEST_P(InterruptLineOff, FromSomeTimeOn) {
  LineRig rig;
  rig.begin();
  EXPECT_TRUE(rig.can.line_is_on());
  EXPECT_EQ(rig.can.counters().line_losses, 0U);
  GetParam().set(rig.wire, true);
  expect_twenty_are_received(rig);
  EXPECT_EQ(rig.can.line_is_on(), !GetParam().notices_later);
  EXPECT_EQ(rig.can.counters().line_losses, GetParam().notices_later ? 1U : 0U);
}

TEST_P(InterruptLineOff, IsForgottenByBeginOnceItIsMended) {
  LineRig rig;
  GetParam().set(rig.wire, true);
  rig.begin();
  GetParam().set(rig.wire, false);
  Frame frame{};
  rig.mark();
  EXPECT_EQ(rig.can.receive(frame), Status::empty);
  EXPECT_EQ(rig.spent().first, 2U) << "still polls";
  rig.begin();
  EXPECT_TRUE(rig.can.line_is_on());
  EXPECT_EQ(rig.can.counters().line_losses, 1U);
  EXPECT_EQ(rig.can.receive(frame), Status::empty);
  EXPECT_EQ(rig.spent().first, 0U) << "no longer";
}

// The wire comes off at each step of the call that reads a frame, and stays off.
TEST(InterruptLine, ComesOffWhileAFrameIsRead) {
  for (int step = 0; step < 20; ++step) {
    LineRig rig;
    rig.begin();
    rig.peer_sends({numbered(1, 8), numbered(2, 8)});
    int so_far = 0;
    rig.wire.on_step([&] {
      if (so_far++ == step) {
        rig.wire.cut_interrupt_line(true);
      }
    });
    EXPECT_EQ(receive_for(rig, milliseconds(1)), (std::vector{numbered(1, 8), numbered(2, 8)}))
        << step;
    EXPECT_EQ(rig.can.counters().discarded, 0U) << step;
    EXPECT_EQ(rig.can.counters().chip_losses, 0U) << step;
  }
}

// A loose contact: it changes at any moment.
TEST(InterruptLine, ThatIsLooseLosesNothing) {
  std::mt19937 generator = seeded_generator();
  for (int round = 0; round < 50; ++round) {
    LineRig rig;
    rig.begin();
    const std::uint32_t seldom = 1 + up_to(generator, 30);
    bool cut = false;
    rig.wire.on_step([&] {
      if (up_to(generator, seldom) == 0) {
        cut = !cut;
        rig.wire.cut_interrupt_line(cut);
      }
    });
    expect_twenty_are_received(rig);
    EXPECT_LE(rig.can.counters().line_losses, 1U);
  }
}

// A program that seldom calls: what came before the first frame was found is lost by the chip, and
// counted as any overflow.
TEST(InterruptLine, ThatComesOffIsNoticedByAProgramThatSeldomCalls) {
  LineRig rig;
  rig.begin();
  rig.wire.cut_interrupt_line(true);
  std::vector<Frame> received;
  for (std::uint32_t i = 0; i < 100; ++i) {
    rig.peer_sends({numbered(i)});
    for (const Frame& frame : rig.receive_all()) {
      received.push_back(frame);
    }
  }
  EXPECT_EQ(received, rig.accepted);
  EXPECT_EQ(received.size() + rig.chip.events().overflowed, 100U);
  EXPECT_GE(received.size(), 100U - 64U) << "calls between two checks";
  EXPECT_GE(rig.can.counters().overflows, 1U);
  EXPECT_LE(rig.can.counters().overflows, rig.chip.events().overflowed);
  EXPECT_EQ(rig.can.counters().line_losses, 1U);
}

// A chip that is reset lets go of the line, too: that is no fault of the wire's.
TEST(InterruptLine, IsNotBlamedForALostChip) {
  for (int step = 0; step < 30; ++step) {
    LineRig rig;
    rig.begin();
    rig.peer_sends({numbered(0x5A5A5A5A, 8)});
    int so_far = 0;
    rig.wire.on_step([&] {
      if (so_far++ == step) {
        rig.chip.reset_pin();
      }
    });
    for (int i = 0; i < 100; ++i) {
      Frame frame{};
      static_cast<void>(rig.can.receive(frame));
    }
    EXPECT_FALSE(rig.can.running()) << step;
    EXPECT_EQ(rig.can.counters().line_losses, 0U) << step;
  }
}

TEST(InterruptLine, OfANodeWithoutOneIsNotMissed) {
  Rig<false> rig;
  rig.begin();
  EXPECT_FALSE(rig.can.line_is_on());
  EXPECT_EQ(rig.can.counters().line_losses, 0U);
}

}  // namespace
}  // namespace roio::test
