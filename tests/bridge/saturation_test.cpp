// A saturated bus over a line that is fast enough for it: nothing lost, in order.
#include <deque>

#include "bridge_rig.hpp"

namespace roio::test {
namespace {

/// Bits that alternate are hardly ever stuffed, so the frames are short.
Frame numbered(std::uint32_t number, int length) {
  Frame frame = extended(0x15555555, Bytes(static_cast<std::size_t>(length), 0x55));
  frame.id = 0x15550000 | ((number * 0x5555U) & 0xFFFF);
  for (int i = 0; i < length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i % 32));
  }
  return frame;
}

TEST(BridgeLoad, Up) {
  BridgeRig rig;
  rig.hello();
  ASSERT_EQ(rig.request(serial::Down::speed, bytes_of(1'000'000)), Status::ok);
  rig.bus.run_for(5ms);
  rig.poll();
  rig.bus.run_for(5ms);
  for (int length = 0; length <= 8; length += 4) {
    std::uint32_t sent = 0;
    rig.records.clear();
    const auto give = [&] { rig.node.send(numbered(sent++, length)); };
    rig.node.on_sent([&](const Frame&) { give(); });
    give();
    give();
    const sim::BusStatistics before = rig.bus.statistics();
    for (int i = 0; i < 20; ++i) {
      rig.bus.run_for(50ms);
      rig.poll();
    }
    const sim::BusStatistics after = rig.bus.statistics();
    rig.node.on_sent(nullptr);
    rig.bus.run_for(20ms);
    const auto frames = rig.frames();
    std::printf("length %d: load %.3f, sent %u, got %zu, damaged %d, dropped %u, overflows %u accepted %llu\n", length,
                std::chrono::duration<double>(after.busy - before.busy).count(), sent, frames.size(),
                rig.damaged, rig.counter(0), rig.counter(1), static_cast<unsigned long long>(rig.board.chip().events().accepted));
  }
}

}  // namespace
}  // namespace roio::test
