#include <gtest/gtest.h>

#include <roio/frame_length.hpp>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <vector>

namespace roio::sim {
namespace {

TEST(CanBus, AFrameTakesItsBits) {
  CanBus bus;
  HostNode sender(bus, 500'000);
  HostNode receiver(bus, 500'000);
  const Frame frame{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};
  bus.run_for(std::chrono::milliseconds(1));
  SimTime end{0};
  bus.on_frame([&](const Frame&, const Controller&) { end = bus.now(); });
  const SimTime start = bus.now();
  sender.send(frame);
  bus.run_for(std::chrono::milliseconds(1));
  // The document's worked frame: 97 bits, of which the last three are intermission.
  const SimTime bit = cycles(1, 500'000);
  EXPECT_GT(end - start, bit * (97 - 3 - 1));
  EXPECT_LE(end - start, bit * (97 - 3 + 1));
}

}  // namespace
}  // namespace roio::sim
