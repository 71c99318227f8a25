// The bridge's image speaks docs/internals/serial-protocol.md, record by record.
#include "bridge_rig.hpp"

namespace roio {
inline bool operator==(const Frame& a, const Frame& b) {
  return tagged_id(a) == tagged_id(b) && a.length == b.length &&
         (is_remote(a.kind) || std::equal(a.data, a.data + a.length, b.data));
}
}  // namespace roio

namespace roio::test {
namespace {

class EachBridge : public testing::TestWithParam<sim::BoardKind> {};
INSTANTIATE_TEST_SUITE_P(Board, EachBridge,
                         testing::Values(sim::BoardKind::uno, sim::BoardKind::leonardo,
                                         sim::BoardKind::mega),
                         [](const auto& kind) { return std::string(sim::to_string(kind.param)); });

TEST_P(EachBridge, WelcomeSaysWhatItIs) {
  BridgeRig rig(GetParam());
  const Bytes welcome = rig.hello();
  const auto board = static_cast<std::uint8_t>(static_cast<int>(GetParam()) + 1);
  // The line has a rate unless it is USB; the interrupt pin is wired.
  const std::uint8_t flags = GetParam() == sim::BoardKind::leonardo ? 2 : 3;
  EXPECT_EQ(welcome, (Bytes{0xF1, 0, 2} + bytes_of(session_number) + bytes_of(0) + bytes_of(0) +
                      Bytes{ROIO_VERSION_MAJOR, ROIO_VERSION_MINOR, ROIO_VERSION_PATCH, board,
                            flags, 16, 0x3E, 0x80} +
                      bytes_of(500'000) + Bytes{0, 0, 254, 0x1F}));
}

TEST_P(EachBridge, FramesOfAllKindsGoUpAndDown) {
  BridgeRig rig(GetParam());
  rig.hello();
  const std::vector<Frame> frames = {
      extended(0x1000400A, {0x5A, 0x2D}),         extended(0x1FFFFFFF),
      extended(0, {0, 0, 0, 0, 0, 0, 0, 0}),      {0x123, FrameKind::standard, 3, {1, 0, 3}},
      {0x7FF, FrameKind::standard_remote, 8, {}}, {0x12345678, FrameKind::extended_remote, 5, {}},
  };
  for (const Frame& frame : frames) {
    rig.node.send(frame);
    rig.bus.run_for(5ms);
    rig.send(frame);
    rig.bus.run_for(5ms);
  }
  EXPECT_EQ(rig.frames(), frames);
  EXPECT_EQ(rig.on_bus, frames);
  EXPECT_EQ(rig.last(serial::Up::results), (Bytes{0xF4, 6, 6, 0, 0, 0, 0x05, 0x55}));
  EXPECT_EQ(rig.damaged, 0);
}

}  // namespace
}  // namespace roio::test
