// A controller that sends, what it counts, and bus-off.
#include "controller_bench.hpp"

namespace roio::sim {
namespace {

TEST(Controller, SendsBitByBit) {
  Bench bench;
  bench.submit(frame);
  EXPECT_EQ(bench.run(Bench::own_bits(frame_wire.size())), frame_wire);
  EXPECT_EQ(bench.run("1 0 1 111111"), "111111111");
  EXPECT_EQ(bench.owner.log, Log{}) << "sent with the last bit of end-of-frame";
  bench.run("1");
  EXPECT_EQ(bench.owner.log, Log{"sent"});
  EXPECT_EQ(bench.run("111 1"), "1111");
  EXPECT_FALSE(bench.controller.busy());
}

TEST(Controller, SendsTheNextRightAfterTheIntermission) {
  Bench bench;
  bench.submit(frame);
  bench.submit(frame);
  bench.run(Bench::own_bits(frame_wire.size()) + acknowledged);
  EXPECT_EQ(bench.run(Bench::own_bits(frame_wire.size())), frame_wire);
}

struct TransmitterCase {
  const char* why;
  std::string wire;
  unsigned transmit_errors;
  Log log;
};

TEST(Controller, TransmitErrorCounter) {
  const std::string whole = Bench::own_bits(frame_wire.size());
  // Bit 36 is RTR, dominant; 37 and 38 are r1 and r0; 41 is a recessive stuff bit.
  const std::string data = Bench::own_bits(45);  // the next is a dominant bit
  const std::string data_error = data + "1";
  const Log bit = {"sending: bit error"};
  const Log bit_bit = {"sending: bit error", "receiving: bit error"};
  const Log bit_form = {"sending: bit error", "receiving: form error"};
  ASSERT_EQ(frame_wire.substr(36, 6),
            "000"
            "0"
            "1"
            "0");
  ASSERT_EQ(frame_wire[45], '1');
  const TransmitterCase cases[] = {
      {"no acknowledgement", whole + "1 1" + flag + delimiter, 8, {"sending: no acknowledgement"}},
      {"recessive data overwritten", data + "0" + flag + delimiter, 8, bit},
      {"dominant start-of-frame does not show", "1" + flag + delimiter, 8, bit},
      {"dominant identifier bit does not show", Bench::own_bits(2) + "1" + flag + delimiter, 8,
       bit},
      {"dominant RTR does not show", Bench::own_bits(36) + "1" + flag + delimiter, 8, bit},
      {"recessive stuff bit of the identifier overwritten: not its fault",
       Bench::own_bits(7) + "0" + flag + delimiter,
       0,
       {"sending: stuff error"}},
      {"recessive stuff bit after the identifier overwritten",
       Bench::own_bits(40) + "0" + flag + delimiter, 8, bit},
      {"the flag's first bit does not show",
       data +
           "0"
           "1" +
           flag + "1",
       16, bit_bit},
      {"the flag's third bit does not show",
       data +
           "0"
           "..1" +
           flag + "1",
       16, bit_bit},
      {"the flag's sixth bit does not show",
       data +
           "0"
           ".....1" +
           flag + "1",
       16, bit_bit},
      {"7 dominant bits after the flag", data + "0" + flag + "0000000" + delimiter, 8, bit},
      {"8 dominant bits after the flag", data + "0" + flag + "00000000", 16, bit},
      {"16 dominant bits after the flag", data + "0" + flag + "0000000000000000", 24, bit},
      {"delimiter, second bit dominant", data + "0" + flag + "10", 16, bit_form},
      {"delimiter, seventh bit dominant", data + "0" + flag + "1111110", 16, bit_form},
      {"delimiter, eighth bit dominant: overload", data + "0" + flag + "11111110" + flag + "1", 8,
       bit},
      {"CRC delimiter dominant", whole + "0" + flag + delimiter, 8, bit},
      {"acknowledge delimiter dominant",
       whole + "1 0 0" + flag + delimiter,
       8,
       {"sending: form error"}},
      {"end of frame, first bit dominant", whole + "1 0 1 0" + flag + delimiter, 8, bit},
      {"end of frame, last bit dominant", whole + "1 0 1 1111110" + flag + delimiter, 8, bit},
      {"intermission dominant: overload",
       whole + "1 0 1 1111111 0" + flag + "0000000" + delimiter,
       0,
       {"sent"}},
      {"the overload flag does not show",
       whole + "1 0 1 1111111 0 1" + flag + "1",
       8,
       {"sent", "receiving: bit error"}},
  };
  for (const TransmitterCase& row : cases) {
    Bench bench;
    bench.submit(frame);
    bench.run(row.wire);
    EXPECT_EQ(bench.controller.transmit_errors(), row.transmit_errors) << row.why;
    EXPECT_EQ(bench.controller.receive_errors(), 0U) << row.why;
    EXPECT_EQ(bench.owner.log, row.log) << row.why;
  }
}

TEST(Controller, ASuccessLowersTheTransmitErrorCounterAndNothingElse) {
  Bench bench;
  bench.make_receive_errors(2);
  bench.submit(frame);
  bench.fail_to_send();
  EXPECT_EQ(bench.counters(), "TEC 8, REC 2");
  bench.run(Bench::own_bits(frame_wire.size()) + acknowledged);
  EXPECT_EQ(bench.counters(), "TEC 7, REC 2");
}

TEST(Controller, ErrorPassiveAbove127TransmitErrors) {
  Bench bench;
  bench.submit(frame);
  for (int i = 0; i < 15; ++i) {
    bench.fail_to_send();
  }
  EXPECT_EQ(bench.counters(), "TEC 120, REC 0");
  EXPECT_EQ(bench.controller.confinement(), Confinement::active);
  bench.run(Bench::own_bits(36));
  // The error that makes it passive is still told with an active flag.
  EXPECT_EQ(bench.run("1 ...... 1"),
            "0"
            "000000"
            "1");
  EXPECT_EQ(bench.counters(), "TEC 128, REC 0");
  EXPECT_EQ(bench.controller.confinement(), Confinement::passive);
  bench.run("1111111 111 11111111");
  bench.run(Bench::own_bits(frame_wire.size()) + acknowledged);
  EXPECT_EQ(bench.counters(), "TEC 127, REC 0");
  EXPECT_EQ(bench.controller.confinement(), Confinement::active);
}

class PassiveTransmitter : public testing::Test {
 protected:
  void SetUp() override {
    bench_.submit(frame);
    for (int i = 0; i < 16; ++i) {
      bench_.fail_to_send();
    }
    ASSERT_EQ(bench_.counters(), "TEC 128, REC 0");
    ASSERT_EQ(bench_.controller.confinement(), Confinement::passive);
    bench_.owner.log.clear();
  }
  Bench bench_;
  const std::string whole = Bench::own_bits(frame_wire.size());
  const std::string suspension = std::string(8, '1');
};

TEST_F(PassiveTransmitter, SuspendsForEightBits) {
  EXPECT_EQ(bench_.run("11111111" + whole), "11111111" + frame_wire);
  bench_.submit(frame);
  bench_.run(acknowledged);
  // Active again with that: no longer.
  EXPECT_EQ(bench_.run(whole), frame_wire);
}

TEST_F(PassiveTransmitter, ReceivesWhileItSuspends) {
  EXPECT_EQ(bench_.run("111" + frame_wire + "1.1 1111111 111").substr(3 + frame_wire.size(), 3),
            "101");
  EXPECT_EQ(bench_.owner.log, Log{frame_text});
  // A receiver does not suspend.
  EXPECT_EQ(bench_.run(whole), frame_wire);
}

TEST_F(PassiveTransmitter, IsNotCountedForALackOfAcknowledgement) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(bench_.run(suspension + whole + "1 1 111111 11111111 111").substr(8 + whole.size()),
              std::string(19, '1'));
    ASSERT_EQ(bench_.counters(), "TEC 128, REC 0");
  }
  EXPECT_EQ(bench_.owner.log.size(), 100U);
}

TEST_F(PassiveTransmitter, IsCountedWhenSomebodyFlagsAfterALackOfAcknowledgement) {
  bench_.run(suspension + whole + "1 1 11111 0");
  EXPECT_EQ(bench_.counters(), "TEC 136, REC 0");
  bench_.run("00000");
  EXPECT_EQ(bench_.counters(), "TEC 136, REC 0") << "once";
}

TEST_F(PassiveTransmitter, IsCountedForAnyOtherError) {
  bench_.run(suspension + Bench::own_bits(36) + "1 111111");
  EXPECT_EQ(bench_.counters(), "TEC 136, REC 0");
  bench_.run("0000000");
  EXPECT_EQ(bench_.counters(), "TEC 136, REC 0");
  bench_.run("0");
  EXPECT_EQ(bench_.counters(), "TEC 144, REC 0") << "8 dominant bits after a passive flag";
}

// --- bus-off -------------------------------------------------------------------------------------

class BusOff : public testing::Test {
 protected:
  void SetUp() override {
    bench_.submit(frame);
    for (int i = 0; i < 16; ++i) {
      bench_.fail_to_send();
    }
    for (int i = 0; i < 15; ++i) {
      bench_.run("11111111" + Bench::own_bits(36) + "1 111111 11111111 111");
    }
    ASSERT_EQ(bench_.counters(), "TEC 248, REC 0");
    ASSERT_EQ(bench_.controller.confinement(), Confinement::passive);
    bench_.run("11111111" + Bench::own_bits(36) + "1");
    ASSERT_EQ(bench_.counters(), "TEC 256, REC 0");
    ASSERT_EQ(bench_.controller.confinement(), Confinement::bus_off);
    bench_.owner.log.clear();
  }
  void expect_recovery_with(const std::string& last) {
    EXPECT_EQ(bench_.controller.confinement(), Confinement::bus_off);
    bench_.run(last);
    EXPECT_EQ(bench_.controller.confinement(), Confinement::active);
    EXPECT_EQ(bench_.counters(), "TEC 0, REC 0");
    EXPECT_EQ(bench_.run(Bench::own_bits(frame_wire.size())), frame_wire) << "sends what waits";
  }
  Bench bench_;
};

TEST_F(BusOff, EndsAfter128Times11RecessiveBits) {
  bench_.run(std::string(128 * 11 - 1, '1'));
  expect_recovery_with("1");
}

TEST_F(BusOff, TenRecessiveBitsDoNotCount) {
  for (int i = 0; i < 200; ++i) {
    bench_.run("0 1111111111");
  }
  bench_.run("0" + std::string(128 * 11 - 1, '1'));
  expect_recovery_with("1");
}

TEST_F(BusOff, SequencesCountThoughFramesComeBetweenThem) {
  for (int i = 0; i < 127; ++i) {
    bench_.run("0 11111111111");
  }
  bench_.run("000000 1111111111");
  expect_recovery_with("1");
}

TEST_F(BusOff, DrivesNothingAndHearsNothing) {
  EXPECT_EQ(bench_.run(frame_wire + "1 0 1 1111111 111"), std::string(frame_wire.size() + 13, '1'));
  EXPECT_EQ(bench_.owner.log, Log{});
}

TEST_F(BusOff, StartsOverWhenTheModeIsSetButEndsWithAReset) {
  bench_.run(std::string(1'100, '1'));
  bench_.controller.set_mode(Controller::Mode::off);
  bench_.controller.set_mode(Controller::Mode::normal);
  bench_.run(std::string(1'397, '1'));
  EXPECT_EQ(bench_.controller.confinement(), Confinement::bus_off);
  bench_.controller.reset_error_counters();
  bench_.controller.set_mode(Controller::Mode::normal);
  bench_.run(integration);
  EXPECT_EQ(bench_.run(Bench::own_bits(frame_wire.size())), frame_wire);
}

}  // namespace
}  // namespace roio::sim
