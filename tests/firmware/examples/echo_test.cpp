// Echo: each message comes back, in order within its priority, and none is lost with the chip.
#include <deque>

#include "sketch_rig.hpp"

namespace roio::test {
namespace {

constexpr Address echo{0, 2};

class Echo : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, Echo, all_boards, board_name);

/// What the sketch can always hold: two received, one in its hand, one to be sent.
constexpr std::size_t most_under_way = 4;
constexpr int messages = 1000;

/// The number in as many bytes as fit.
Bytes numbered(int number) {
  Bytes data(static_cast<std::size_t>(number % 9));
  for (std::size_t i = 0; i < data.size(); ++i) {
    data[i] = static_cast<std::uint8_t>(number >> (i % 2 * 8));
  }
  return data;
}

TEST_P(Echo, SendsAThousandBackInOrder) {
  SketchRig rig(GetParam(), "Echo");
  rig.bus.run_for(20ms);

  std::deque<std::string> expected[2];  // by priority
  int sent = 0;
  const auto send_next = [&] {
    const Priority priority = sent % 7 == 3 ? Priority::urgent : Priority::normal;
    const Bytes data = numbered(sent++);
    rig.send(echo, data, priority);
    expected[static_cast<int>(priority)].push_back(
        text(frame_of(echo, pc_address, data, priority)));
  };
  int back = 0;
  rig.pc.on_receive([&](const Frame& frame) {
    auto& queue = expected[static_cast<int>(unpack_id(frame.id).priority)];
    ASSERT_FALSE(queue.empty()) << text(frame);
    ASSERT_EQ(text(frame), queue.front()) << "message " << back << " of those that came back";
    queue.pop_front();
    ++back;
    if (sent < messages) {
      send_next();
    }
  });
  rig.bus.after(1ms, [&] {
    for (std::size_t i = 0; i < most_under_way; ++i) {
      send_next();
    }
  });
  rig.bus.run_for(2s);
  EXPECT_EQ(back, messages);
  EXPECT_EQ(rig.board.chip().events().overflowed, 0U);
}

TEST_P(Echo, AnswersBroadcastsAndNobodyElses) {
  SketchRig rig(GetParam(), "Echo");
  rig.bus.run_for(20ms);
  rig.send({0, 3}, {1});
  rig.send({1, 2}, {2});
  rig.send({1, broadcast_node}, {3});
  rig.send({0, broadcast_node}, {4});
  EXPECT_EQ(rig.run(10ms), Texts{"0.2 > 0.10: 04"});
}

TEST(EchoUno, GoesOnAfterTheChipWasWithoutPower) {
  SketchRig rig(sim::BoardKind::uno, "Echo");
  rig.bus.run_for(20ms);
  rig.board.chip().power_cycle();
  rig.bus.run_for(20ms);
  rig.send(echo, {7});
  EXPECT_EQ(rig.run(10ms), Texts{"0.2 > 0.10: 07"});
}

TEST(EchoUno, BeginsWhenTheChipIsPluggedIn) {
  SketchRig rig(sim::BoardKind::uno, "Echo");
  rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  rig.bus.run_for(200ms);
  rig.board.set_chip_fault(sim::SpiWire::Fault::none);
  rig.bus.run_for(200ms);
  rig.send(echo, {7});
  EXPECT_EQ(rig.run(10ms), Texts{"0.2 > 0.10: 07"});
}

// Two messages lie in the chip and wait for a bus that others keep busy, and the sketch has a third
// one. The chip forgets its two; the third comes back.
TEST(EchoUno, KeepsItsMessageWhenTheChipIsLost) {
  SketchRig rig(sim::BoardKind::uno, "Echo");
  rig.bus.run_for(20ms);
  const Frame first_of_all{0, FrameKind::standard, 8, {}};
  for (std::uint8_t number = 1; number <= 3; ++number) {
    rig.send(echo, {number});
  }
  for (int i = 0; i < 100; ++i) {
    rig.pc.send(first_of_all);
  }
  ASSERT_EQ(rig.run(5ms), Texts{});
  rig.board.chip().power_cycle();
  EXPECT_EQ(rig.run(100ms), Texts{"0.2 > 0.10: 03"});
}

}  // namespace
}  // namespace roio::test
