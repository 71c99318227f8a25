// Sniffer: prints every frame there is on a bus that it takes no part in, and counts what it
// cannot.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

/// Two nodes that talk, since the sniffer acknowledges nothing.
class SnifferRig : public SketchRig {
 public:
  explicit SnifferRig(sim::BoardKind kind = sim::BoardKind::uno,
                      const sim::BoardOptions& options = {})
      : SketchRig(kind, "Sniffer", options) {
    bus.run_for(50ms);
  }

  sim::HostNode listener{bus, bitrate_bps};
};

struct Row {
  Frame frame;
  const char* line;
};
Frame frame(std::uint32_t id, FrameKind kind, const Bytes& data) {
  Frame result{id, kind, static_cast<std::uint8_t>(data.size()), {}};
  std::copy(data.begin(), data.end(), result.data);
  return result;
}
// As the lines of docs/cli.md, with one space for several.
const Row rows[] = {
    {frame(0x1000400A, FrameKind::extended, {0x5A, 0x2D, 0x00}),
     "0.10 -> 0.2 normal message [3] 5A 2D 00"},
    {frame(0x001FE001, FrameKind::extended, {}), "0.1 -> 0.* urgent message [0]"},
    {frame(0x146323C8, FrameKind::extended, {1, 2, 3, 4, 5}),
     "3.200 -> 3.25 normal system [5] 01 02 03 04 05"},
    {frame(0x1BFFDFFE, FrameKind::extended, {0xFF, 0xEE, 0xDD, 0xCC, 0xBB, 0xAA, 0x99, 0x08}),
     "31.254 -> 31.254 normal stream [8] FF EE DD CC BB AA 99 08"},
    {frame(0x123, FrameKind::standard, {0x11, 0x22}), "foreign 11-bit 123 [2] 11 22"},
    {frame(0x007, FrameKind::standard, {}), "foreign 11-bit 007 [0]"},
    {frame(0x7FF, FrameKind::standard_remote, {0, 0, 0, 0}),
     "foreign 11-bit 7FF [4] remote request"},
    {frame(0x1000400A, FrameKind::extended_remote, {0, 0}),
     "foreign 29-bit 1000400A [2] remote request"},
    {frame(0x1C00400A, FrameKind::extended, {0x11}), "foreign 29-bit 1C00400A [1] 11"},
    {frame(0x000040FF, FrameKind::extended, {}), "foreign 29-bit 000040FF [0]"},
};

TEST(Sniffer, PrintsFramesOfAllKinds) {
  SnifferRig rig;
  for (const Row& row : rows) {
    rig.pc.send(row.frame);
    EXPECT_EQ(rig.run_for_lines(10ms), Texts{row.line});
  }
}

TEST(Sniffer, PrintsThemOnAMegaToo) {
  SnifferRig rig(sim::BoardKind::mega);
  rig.pc.send(rows[0].frame);
  EXPECT_EQ(rig.run_for_lines(10ms), Texts{rows[0].line});
}

// Each try of a frame that nobody acknowledges looks whole, once its sender is error-passive.
TEST(Sniffer, TakesNoPart) {
  SnifferRig rig;
  rig.listener.controller().set_mode(sim::Controller::Mode::off);
  rig.pc.send(rows[0].frame);
  const Texts lines = rig.run_for_lines(100ms);
  EXPECT_EQ(lines, Texts(lines.size(), rows[0].line));
  EXPECT_EQ(rig.pc.waiting(), 1U) << "nobody acknowledges";
  EXPECT_EQ(rig.pc.controller().transmit_errors(), 128U);
  EXPECT_EQ(rig.board.chip().events().sent, 0U);
}

TEST(Sniffer, WithoutIntPrintsThemAllAndSaysThatItIsMissing) {
  for (const bool stuck_low : {false, true}) {
    sim::BoardOptions options;
    options.interrupt_pin = std::nullopt;
    SnifferRig rig(sim::BoardKind::uno, options);
    EXPECT_EQ(rig.lines, Texts{"! INT not connected: slower, and may lose more"});
    if (stuck_low) {
      rig.board.set_pin(2, false);
    }
    for (const Row& row : rows) {
      rig.pc.send(row.frame);
      EXPECT_EQ(rig.run_for_lines(10ms), Texts{row.line});
    }
  }
}

// As long a line as there is takes 5 ms; what comes faster waits, up to 60 frames, none lost.
TEST(Sniffer, PrintsABurstLater) {
  SnifferRig rig;
  Texts expected;
  for (std::uint8_t i = 0; i < 60; ++i) {
    rig.pc.send(frame_of({0, 1}, {0, 2}, {i}));
    expected.push_back("0.1 -> 0.2 normal message [1] " + text(frame_of({}, {}, {i})).substr(11));
  }
  EXPECT_EQ(rig.run_for_lines(1s), expected);
}

class SnifferOnAFullBus : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(, SnifferOnAFullBus, testing::Values(0, 8), [](const auto& row) {
  return "FramesOf" + std::to_string(row.param) + "Bytes";
});

// Every frame is printed or counted.
TEST_P(SnifferOnAFullBus, CountsWhatItCannotPrint) {
  SnifferRig rig;
  constexpr std::uint64_t frames = 8000;
  for (std::uint64_t i = 0; i < frames; ++i) {
    rig.pc.send(frame_of({31, 254}, {31, 254}, Bytes(static_cast<std::size_t>(GetParam()), 1)));
  }
  const Texts lines = rig.run_for_lines(4s);
  ASSERT_EQ(rig.pc.waiting(), 0U);
  Texts losses;
  std::uint64_t printed = 0;
  for (const std::string& line : lines) {
    if (line.starts_with("! ")) {
      losses.push_back(line);
    } else {
      EXPECT_TRUE(line.starts_with("31.254 -> 31.254 normal message [")) << line;
      ++printed;
    }
  }
  EXPECT_GT(printed, 100U);
  ASSERT_GE(losses.size(), 1U);
  EXPECT_LE(losses.size(), 4U) << "once a second";
  const std::uint64_t lost = rig.board.chip().events().overflowed;
  EXPECT_EQ(losses.back(), "! " + std::to_string(frames - printed - lost) +
                               " frames not printed, " + std::to_string(lost) +
                               " times some lost by the chip");
  EXPECT_EQ(lost, 0U);
}

TEST(Sniffer, SaysThatThereIsNoChipAndListensWhenThereIs) {
  SketchRig rig(sim::BoardKind::uno, "Sniffer");
  rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  EXPECT_EQ(rig.run_for_lines(500ms),
            Texts{"! Cannot begin, no controller answers: check the wiring and the CS pin"});
  rig.board.set_chip_fault(sim::SpiWire::Fault::none);
  rig.bus.run_for(200ms);
  sim::HostNode listener(rig.bus, bitrate_bps);
  rig.pc.send(rows[0].frame);
  EXPECT_EQ(rig.run_for_lines(50ms), Texts{rows[0].line});
}

}  // namespace
}  // namespace roio::test
