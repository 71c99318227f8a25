// The bus: its statistics, and what observers see.
#include <gtest/gtest.h>

#include <roio/frame_length.hpp>
#include <roio/sim/can_bus.hpp>

#include "can_bus_rig.hpp"

namespace roio::sim {
namespace {

using std::chrono::milliseconds;

TEST(CanBus, LoadOfASaturatedBusIsOne) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  send_without_end(sender, document_frame);
  bus.run_for(std::chrono::seconds(1));
  // All but the 11 bits at the beginning.
  EXPECT_NEAR(bus.statistics().load(), 1 - 11.0 / rate, 1e-9);
}

TEST(CanBus, LoadCountsEachFramesBits) {
  CanBus bus;
  EXPECT_EQ(bus.statistics().load(), 0);
  Station sender(bus);
  Station receiver(bus);
  for (int i = 0; i < 100; ++i) {
    bus.at(milliseconds(1 + i), [&] { sender.node.send(document_frame); });
  }
  bus.run_until(milliseconds(200));
  EXPECT_EQ(bus.statistics().busy, bit * 97 * 100);
  EXPECT_EQ(bus.statistics().time, SimTime(milliseconds(200)));
  EXPECT_DOUBLE_EQ(bus.statistics().load(), 0.097);
}

TEST(CanBus, AnErrorFrameIsPartOfTheLoad) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  sender.node.send(document_frame);
  bus.after(bit * 45, [&] { bus.flip_next_bit(&sender.node.controller()); });
  bus.run_for(milliseconds(1));
  // 46 bits, then 6 of the sender's flag of which the last ones are the receiver's first, then the
  // rest of the receiver's, 8 of the delimiter, 3 of the intermission; and the frame once more.
  const SimTime busy = bus.statistics().busy - bit * 97;
  EXPECT_GE(busy, bit * (46 + 6 + 8 + 3));
  EXPECT_LE(busy, bit * (46 + 12 + 8 + 3));
  EXPECT_EQ(bus.statistics().transmit_errors, 1U);
  EXPECT_EQ(bus.statistics().frames, 1U);
  EXPECT_EQ(bus.statistics().flipped_bits, 1U);
}

TEST(CanBus, LatencyByPriority) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  bus.run_for(milliseconds(1));
  a.node.send(extended(0x10000001));
  a.node.send(extended(0x10000001));
  b.node.send(extended(0x00000001));
  bus.run_for(milliseconds(1));
  const BusStatistics statistics = bus.statistics();
  const SimTime end_of_frame = bit * -4 + bit * 4 / 5;  // its last bit's sample point
  const SimTime urgent = bit * wire_bits(extended(0x00000001));
  const SimTime normal = bit * wire_bits(extended(0x10000001));
  EXPECT_EQ(statistics.urgent.frames, 1U);
  EXPECT_EQ(statistics.urgent.max, urgent + end_of_frame);
  EXPECT_EQ(statistics.normal.frames, 2U);
  EXPECT_EQ(statistics.normal.max, urgent + 2 * normal + end_of_frame);
  EXPECT_EQ(statistics.normal.mean(), urgent + normal * 3 / 2 + end_of_frame);
  EXPECT_EQ(BusStatistics::Latency{}.mean(), SimTime(0));
}

TEST(CanBus, StandardFramesCountAsNormal) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  sender.node.send({0x001, FrameKind::standard, 0, {}});
  bus.run_for(milliseconds(1));
  EXPECT_EQ(bus.statistics().normal.frames, 1U);
  EXPECT_EQ(bus.statistics().urgent.frames, 0U);
}

TEST(CanBus, ObserversSeeEachFrameOnceWithItsSender) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  Texts seen;
  bus.on_frame([&](const Frame& frame, const Controller& sender) {
    seen.push_back((&sender == &a.node.controller() ? "a " : "b ") + text_of(frame));
  });
  a.node.send(extended(0x10000001));
  b.node.send(extended(0x10000002));
  bus.run_for(milliseconds(2));
  EXPECT_EQ(seen, (Texts{"a 10000001 DLC 1 00", "b 10000002 DLC 1 00"}));
}

}  // namespace
}  // namespace roio::sim
