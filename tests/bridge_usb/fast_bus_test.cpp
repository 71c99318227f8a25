// A full bus of 1 Mbit/s is more than an AVR can hand on: what is lost is told, and the rest is in
// order. What found no room in the line is told frame by frame. What the controller lost is told
// as times, for it knows no more; only the simulator knows how many those were.
#include <cstdio>

#include "bridge_rig.hpp"

namespace roio::test {
namespace {

struct FastBus {
  std::uint32_t line_bps;
  int length;
  sim::BoardKind kind = sim::BoardKind::uno;
};

std::string name_of(const testing::TestParamInfo<FastBus>& row) {
  return std::to_string(row.param.length) + "_" +
         (row.param.kind == sim::BoardKind::leonardo ? "OverUsb"
                                                     : std::to_string(row.param.line_bps));
}

class OneMegabit : public testing::TestWithParam<FastBus> {
 protected:
  static constexpr std::uint32_t fast_bps = 1'000'000;

  void SetUp() override {
    rig.hello();
    rig.node.controller().set_mode(sim::Controller::Mode::off);
    ASSERT_EQ(rig.request(serial::Down::bus, bytes_of(fast_bps) + Bytes{0}), Status::ok);
    ASSERT_NO_FATAL_FAILURE(rig.set_line_rate(GetParam().line_bps));
    rig.records.clear();
    fast.on_sent([this](const Frame& /*frame*/) { give(); });
  }

  /// Frames with few stuffed bits, so that they are short; 20 bits of the number are in the
  /// identifier.
  [[nodiscard]] static std::uint32_t id_of(std::uint32_t number) {
    return 0x15500000 | (number & 0xFFFFF);
  }
  void give() {
    fast.send(extended(id_of(sent++), Bytes(static_cast<std::size_t>(GetParam().length), 0x55)));
  }
  void take() {
    for (const Frame& frame : rig.frames()) {
      ASSERT_GE(frame.id, id_of(next)) << "out of order, or twice";
      next = frame.id - id_of(0) + 1;
      ++received;
    }
    rig.records.clear();
  }

  BridgeRig rig{GetParam().kind};
  sim::HostNode fast{rig.bus, fast_bps};
  std::uint32_t sent = 0;
  std::uint32_t next = 0;
  std::uint32_t received = 0;
};

TEST_P(OneMegabit, WhatIsLostIsTold) {
  const auto lost_before = rig.board.chip().events().overflowed;
  give();
  give();
  for (int i = 0; i < 20 && !HasFailure(); ++i) {
    rig.poll();
    rig.bus.run_for(100ms);
    take();
  }
  fast.on_sent(nullptr);
  rig.bus.run_for(100ms);
  take();
  const auto lost = static_cast<std::uint32_t>(rig.board.chip().events().overflowed - lost_before);
  const std::uint32_t times = rig.counter(overflow_counter);
  EXPECT_EQ(received + rig.counter(dropped_counter) + lost, sent);
  EXPECT_EQ(times > 0, lost > 0);
  EXPECT_LE(times, lost);
  EXPECT_EQ(rig.damaged, 0);
  EXPECT_GT(received, sent / 2);
  std::printf("of %u frames %u arrived, %u found no room, the controller lost %u in %u times\n",
              sent, received, rig.counter(dropped_counter), lost, times);
}

INSTANTIATE_TEST_SUITE_P(Bridge, OneMegabit,
                         testing::Values(FastBus{2'000'000, 0}, FastBus{2'000'000, 4},
                                         FastBus{2'000'000, 8}, FastBus{1'000'000, 8},
                                         FastBus{2'000'000, 0, sim::BoardKind::leonardo},
                                         FastBus{2'000'000, 8, sim::BoardKind::leonardo}),
                         name_of);

}  // namespace
}  // namespace roio::test
