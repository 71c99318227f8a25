// A controller: its modes, and the arbitration that it loses.
#include "controller_bench.hpp"

namespace roio::sim {
namespace {

// --- arbitration ---------------------------------------------------------------------------------

TEST(Controller, LosesArbitrationAndReceivesTheWinner) {
  const Frame stronger{0x1000400A & ~UINT32_C(2), FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};
  Bench bench;
  bench.submit(frame);
  const std::string wire = wire_text(stronger);
  const std::string driven = bench.run(wire + "1.1 1111111 111");
  const std::size_t lost_at = 34;  // identifier bit 1
  EXPECT_EQ(driven.substr(0, lost_at + 1), frame_wire.substr(0, lost_at + 1));
  EXPECT_EQ(driven.substr(lost_at + 1), std::string(wire.size() - lost_at - 1, '1') +
                                            "101"
                                            "1111111"
                                            "111");
  EXPECT_EQ(bench.owner.log, (Log{"arbitration lost", "10004008 DLC 3 5A 2D 00"}));
  EXPECT_EQ(bench.counters(), "TEC 0, REC 0");
  EXPECT_EQ(bench.run(Bench::own_bits(frame_wire.size())), frame_wire) << "and tries again at once";
}

TEST(Controller, AnErrorInTheWinnersFrameIsTheReceiversError) {
  Bench bench;
  bench.submit(frame);
  bench.run(Bench::own_bits(1) + "0 0000");
  EXPECT_EQ(bench.owner.log, (Log{"arbitration lost", "receiving: stuff error"}));
  EXPECT_EQ(bench.counters(), "TEC 0, REC 1");
}

TEST(Controller, StartsWithTheIdentifierWhenAnotherStartsInTheThirdBitOfIntermission) {
  Bench bench;
  bench.run(frame_wire + "1.1 1111111 1");
  bench.submit(frame);
  EXPECT_EQ(bench.run("1 0"), "11");
  EXPECT_EQ(bench.run(Bench::own_bits(frame_wire.size() - 1)), frame_wire.substr(1));
}

TEST(Controller, ReceivesWhatStartsInTheThirdBitOfIntermission) {
  Bench bench;
  bench.run(frame_wire + "1.1 1111111 11" + frame_wire + acknowledged);
  EXPECT_EQ(bench.owner.log, (Log{frame_text, frame_text}));
}

// --- modes ---------------------------------------------------------------------------------------

TEST(Controller, WaitsForElevenRecessiveBits) {
  Owner owner;
  Controller controller(owner);
  controller.set_mode(Controller::Mode::normal);
  owner.queue.push_back(frame);
  controller.request();
  const auto bits = [&](int count, std::uint8_t level) {
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(controller.begin_bit(), recessive);
      controller.sample(level);
    }
  };
  bits(10, recessive);
  bits(1, dominant);
  bits(10, recessive);
  EXPECT_EQ(owner.log, Log{});
  bits(1, recessive);
  EXPECT_EQ(owner.log, Log{"integrated"});
  EXPECT_EQ(controller.begin_bit(), dominant);
}

TEST(Controller, AListenerDrivesNothingAndCountsNothing) {
  Bench bench(Controller::Mode::listen_only);
  bench.submit(frame);
  EXPECT_TRUE(bench.controller.quiet()) << "it has nothing to do, though a frame waits";
  const std::string wires[] = {frame_wire + acknowledged,
                               frame_wire + "1 1 000000 11111111 111",
                               wrong_crc + "1 0 1 000000 111111111111",
                               "000000 000000 00000000 11111111 111",
                               frame_wire + "1 0 1 1111110 000000 11111111 111",
                               frame_wire + "1 0 1 1111111 0 000000 11111111 111"};
  for (const std::string& wire : wires) {
    EXPECT_EQ(bench.run(wire).find('0'), std::string::npos) << wire;
    EXPECT_EQ(bench.counters(), "TEC 0, REC 0") << wire;
    bench.owner.log.clear();
    bench.run(frame_wire + acknowledged);
    EXPECT_EQ(bench.owner.log, Log{frame_text}) << "after " << wire;
  }
}

TEST(Controller, AListenerHearsOfErrors) {
  Bench bench(Controller::Mode::listen_only);
  bench.run(frame_wire + "1 1 0");
  bench.run("00000 11111111 111");
  EXPECT_EQ(bench.owner.log, (Log{"receiving: form error", "integrated"}));
}

TEST(Controller, AsleepItTellsOfActivityOnly) {
  Bench bench(Controller::Mode::asleep);
  bench.submit(frame);
  EXPECT_EQ(bench.run("1111 0 1 0"), "1111111");
  EXPECT_EQ(bench.owner.log, (Log{"activity", "activity"}));
}

TEST(Controller, OffItDoesNothing) {
  Bench bench(Controller::Mode::off);
  bench.submit(frame);
  EXPECT_EQ(bench.run("1111 0 1 0"), "1111111");
  EXPECT_EQ(bench.owner.log, Log{});
  EXPECT_TRUE(bench.controller.quiet());
}

TEST(Controller, ItsModeMayBeSwitchedInAnyCallback) {
  const std::string wires[] = {
      Bench::own_bits(frame_wire.size()) + acknowledged,  // sent
      wire_text({1, FrameKind::extended, 0, {}}),         // arbitration lost
      Bench::own_bits(36) + "1",                          // error
      "0" + wire_text({0, FrameKind::extended, 0, {}}),
  };
  for (const std::string& wire : wires) {
    Bench bench;
    bench.submit(frame);
    bench.owner.on_event = [&](const std::string&) {
      bench.controller.set_mode(Controller::Mode::off);
    };
    bench.run(wire + "1111");
    EXPECT_EQ(bench.owner.log.size(), 1U) << wire;
    EXPECT_EQ(bench.run("1010000001"), "1111111111") << wire;
    EXPECT_EQ(bench.owner.log.size(), 1U) << "off: " << wire;
  }
}

TEST(Controller, ACutTransmitterDrivesNothingAndEndsBusOff) {
  Bench bench;
  bench.controller.cut_transmitter(true);
  bench.submit(frame);
  // Each bit of its flag that does not show is an error and begins the flag anew.
  EXPECT_EQ(bench.run("1"), "1");
  EXPECT_EQ(bench.counters(), "TEC 8, REC 0");
  EXPECT_EQ(bench.run(std::string(15, '1')), std::string(15, '1'));
  EXPECT_EQ(bench.counters(), "TEC 128, REC 0");
}

}  // namespace
}  // namespace roio::sim
