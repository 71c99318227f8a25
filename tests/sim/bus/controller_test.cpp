// One controller, and the wire in the test's hand: what it drives and counts, bit by bit. The cases
// of the error counters are those of ISO 16845-1 (7.6 receiver, 8.6 transmitter).
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <optional>
#include <roio/sim/controller.hpp>
#include <string>
#include <vector>

#include "wire_text.hpp"

namespace roio::sim {
namespace {

using test::digits_of;
using test::text_of;
using test::wire_text;
using Log = std::vector<std::string>;

const Frame frame{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};
const std::string frame_text = "1000400A DLC 3 5A 2D 00";
// As docs/protocol.md has it.
const std::string frame_wire = digits_of(
    "0 100000(1)00000(1) 11 000100000(1)00000(1)1010 000 0(1)011 01011010 00101101 00000(1)000 "
    "111011000010110");
// CRC delimiter, acknowledgement by somebody, its delimiter, end of frame, intermission.
const std::string acknowledged = "1 0 1 1111111 111";
const std::string integration(11, '1');

class Owner final : public ControllerClient {
 public:
  std::deque<Frame> queue;
  Log log;
  std::function<void(const std::string&)> on_event;

  std::optional<Submission> next_submission() override {
    return queue.empty() ? std::nullopt : std::optional(Submission{queue.front(), SimTime(0)});
  }
  void on_transmitted() override {
    queue.pop_front();
    note("sent");
  }
  void on_arbitration_lost() override { note("arbitration lost"); }
  void on_transmit_error(BusError error) override {
    note(std::string("sending: ") + to_string(error));
  }
  void on_received(const Frame& received) override { note(text_of(received)); }
  void on_receive_error(BusError error) override {
    note(std::string("receiving: ") + to_string(error));
  }
  void on_confinement_changed() override {}
  void on_integrated() override { note("integrated"); }
  void on_bus_activity() override { note("activity"); }

 private:
  void note(const std::string& what) {
    log.push_back(what);
    if (on_event) {
      on_event(what);
    }
  }
};

class Bench {
 public:
  Owner owner;
  Controller controller{owner};

  explicit Bench(Controller::Mode mode = Controller::Mode::normal) {
    controller.set_mode(mode);
    run(integration);
    owner.log.clear();
  }

  /// One bit a character: 0 and 1 are the level of the wire, whatever the node drives; at a dot,
  /// the wire is as the node drives it. Everything else separates.
  /// @return what the node drove.
  std::string run(const std::string& wire) {
    std::string driven;
    for (const char c : wire) {
      if (c == '0' || c == '1' || c == '.') {
        const std::uint8_t output = controller.begin_bit();
        driven += output == dominant ? '0' : '1';
        controller.sample(c == '.' ? output : c == '0' ? dominant : recessive);
      }
    }
    return driven;
  }

  void submit(const Frame& what) {
    owner.queue.push_back(what);
    controller.request();
  }

  /// The counters, as "TEC 8, REC 0".
  [[nodiscard]] std::string counters() const {
    return "TEC " + std::to_string(controller.transmit_errors()) + ", REC " +
           std::to_string(controller.receive_errors());
  }

  /// One attempt of an active node that ends in a bit error: the last bit of the identifier, which
  /// is dominant, and its flag and delimiter and intermission.
  void fail_to_send() { run(own_bits(36) + "1 ...... 11111111 111"); }

  /// That many bits of the node's own frame, start-of-frame first, as it drives them.
  static std::string own_bits(std::size_t count) { return std::string(count, '.'); }

  void make_receive_errors(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      // Another node's flag, seen by a node that is active or passive.
      run("000000 000000 11111111 111");
    }
  }
};

// --- receiving -----------------------------------------------------------------------------------

TEST(Controller, ReceivesAndAcknowledges) {
  Bench bench;
  EXPECT_EQ(bench.run(frame_wire), std::string(frame_wire.size(), '1'));
  EXPECT_EQ(bench.run("1 . 1 11111"), "10111111");
  EXPECT_EQ(bench.owner.log, Log{}) << "valid at the last bit of end-of-frame but one";
  bench.run("1");
  EXPECT_EQ(bench.owner.log, Log{frame_text});
  EXPECT_EQ(bench.run("1 111"), "1111");
  EXPECT_EQ(bench.owner.log, Log{frame_text});
  EXPECT_EQ(bench.counters(), "TEC 0, REC 0");
}

TEST(Controller, ReceivesFramesBackToBack) {
  Bench bench;
  for (int i = 0; i < 3; ++i) {
    bench.run(frame_wire + acknowledged);
  }
  EXPECT_EQ(bench.owner.log, (Log{frame_text, frame_text, frame_text}));
}

struct ReceiverCase {
  const char* why;
  std::string wire;
  unsigned receive_errors;
  Log log;
};

// Six dominant bits from start-of-frame on: a stuff error at the sixth.
const std::string stuff_error = "000000";
const std::string flag = "......";
const std::string delimiter = "11111111";
const Log stuff = {"receiving: stuff error"};
const Log stuff_bit = {"receiving: stuff error", "receiving: bit error"};
const Log stuff_form = {"receiving: stuff error", "receiving: form error"};
const std::string received = frame_wire + "1 0 1 1111111";
const std::string wrong_crc = frame_wire.substr(0, frame_wire.size() - 1) + "1";

TEST(Controller, ReceiveErrorCounter) {
  const ReceiverCase cases[] = {
      {"a stuff error", stuff_error + flag + delimiter, 1, stuff},
      {"its flag's first bit does not show", stuff_error + "1" + flag + "1", 9, stuff_bit},
      {"its flag's third bit does not show", stuff_error + "..1" + flag + "1", 9, stuff_bit},
      {"its flag's sixth bit does not show", stuff_error + ".....1" + flag + "1", 9, stuff_bit},
      {"a dominant bit after the flag", stuff_error + flag + "0" + delimiter, 9, stuff},
      {"7 dominant bits after the flag", stuff_error + flag + "0000000" + delimiter, 9, stuff},
      {"8 dominant bits after the flag", stuff_error + flag + "00000000", 17, stuff},
      {"15 dominant bits after the flag", stuff_error + flag + "000000000000000", 17, stuff},
      {"16 dominant bits after the flag", stuff_error + flag + "0000000000000000", 25, stuff},
      {"delimiter, second bit dominant", stuff_error + flag + "10", 2, stuff_form},
      {"delimiter, seventh bit dominant", stuff_error + flag + "1111110", 2, stuff_form},
      {"delimiter, eighth bit dominant: overload", stuff_error + flag + "11111110" + flag + "1", 1,
       stuff},
      {"intermission, first bit dominant: overload",
       received + "0" + flag + delimiter,
       0,
       {frame_text}},
      {"intermission, second bit dominant: overload",
       received + "10" + flag + delimiter,
       0,
       {frame_text}},
      {"a dominant bit after the overload flag",
       received + "0" + flag + "0" + delimiter,
       0,
       {frame_text}},
      {"7 dominant bits after the overload flag",
       received + "0" + flag + "0000000" + delimiter,
       0,
       {frame_text}},
      {"8 dominant bits after the overload flag",
       received + "0" + flag + "00000000",
       8,
       {frame_text}},
      {"the overload flag's third bit does not show",
       received + "0..1" + flag + "1",
       8,
       {frame_text, "receiving: bit error"}},
      {"overload delimiter, second bit dominant",
       received + "0" + flag + "10",
       1,
       {frame_text, "receiving: form error"}},
      {"overload delimiter, eighth bit dominant",
       received + "0" + flag + "11111110" + flag + "1",
       0,
       {frame_text}},
      {"CRC error", wrong_crc + "1 1 1" + flag + delimiter, 1, {"receiving: CRC error"}},
      {"CRC delimiter dominant", frame_wire + "0" + flag + delimiter, 1, {"receiving: form error"}},
      {"its acknowledgement does not show",
       frame_wire + "1 1" + flag + delimiter,
       1,
       {"receiving: bit error"}},
      {"acknowledge delimiter dominant",
       frame_wire + "1 . 0" + flag + delimiter,
       1,
       {"receiving: form error"}},
      {"end of frame, first bit dominant",
       frame_wire + "1 . 1 0" + flag + delimiter,
       1,
       {"receiving: form error"}},
      {"end of frame, sixth bit dominant",
       frame_wire + "1 . 1 111110" + flag + delimiter,
       1,
       {"receiving: form error"}},
      {"end of frame, seventh bit dominant: overload, and the frame is valid",
       frame_wire + "1 . 1 1111110" + flag + delimiter,
       0,
       {frame_text}},
  };
  for (const ReceiverCase& row : cases) {
    Bench bench;
    bench.run(row.wire);
    EXPECT_EQ(bench.controller.receive_errors(), row.receive_errors) << row.why;
    EXPECT_EQ(bench.controller.transmit_errors(), 0U) << row.why;
    EXPECT_EQ(bench.owner.log, row.log) << row.why;
  }
}

TEST(Controller, TheFlagOfACrcErrorComesAfterTheAcknowledgeDelimiter) {
  Bench bench;
  bench.run(wrong_crc);
  EXPECT_EQ(bench.run("1 1 1 ......1"),
            "111"
            "0000001");
}

TEST(Controller, TheFlagOfAnyOtherErrorComesAtTheNextBit) {
  Bench bench;
  EXPECT_EQ(bench.run("000000 ......1"),
            "111111"
            "0000001");
  EXPECT_EQ(Bench().run("000000 ..1 ......1"),
            "111111"
            "000"
            "0000001")
      << "and anew";
}

TEST(Controller, EachFrameThatItAcknowledgesLowersTheReceiveErrorCounter) {
  Bench bench;
  bench.make_receive_errors(1);
  EXPECT_EQ(bench.counters(), "TEC 0, REC 1");
  bench.run(frame_wire + "1");
  EXPECT_EQ(bench.counters(), "TEC 0, REC 1");
  bench.run(".");
  EXPECT_EQ(bench.counters(), "TEC 0, REC 0") << "at the acknowledgement";
  bench.run("1 1111111 111" + frame_wire + acknowledged);
  EXPECT_EQ(bench.counters(), "TEC 0, REC 0") << "0 at the least";
}

TEST(Controller, ErrorPassiveAt128ReceiveErrorsAndActiveAgainAt127) {
  Bench bench;
  bench.make_receive_errors(127);
  EXPECT_EQ(bench.controller.confinement(), Confinement::active);
  bench.make_receive_errors(1);
  EXPECT_EQ(bench.counters(), "TEC 0, REC 128");
  EXPECT_EQ(bench.controller.confinement(), Confinement::passive);
  bench.make_receive_errors(20);
  EXPECT_GT(bench.controller.receive_errors(), 140U);
  bench.run(frame_wire + "1.1 1111111 111");
  EXPECT_EQ(bench.counters(), "TEC 0, REC 127") << "one success, wherever it was";
  EXPECT_EQ(bench.controller.confinement(), Confinement::active);
  bench.run(frame_wire + "1.1 1111111 111");
  EXPECT_EQ(bench.counters(), "TEC 0, REC 126");
}

TEST(Controller, ReceiveErrorsStopAt255) {
  Bench bench;
  bench.run("000000 000000" + std::string(320, '0'));
  EXPECT_EQ(bench.counters(), "TEC 0, REC 255");
}

TEST(Controller, AnErrorPassiveReceiverFlagsRecessively) {
  Bench bench;
  bench.make_receive_errors(128);
  EXPECT_EQ(bench.run("000000 111111 11111111 111"), std::string(23, '1'));
  EXPECT_EQ(bench.run(frame_wire + "1.1 1111111 111").substr(frame_wire.size(), 3), "101")
      << "but acknowledges";
}

TEST(Controller, APassiveFlagIsOverAfterSixEqualBits) {
  Bench bench;
  bench.make_receive_errors(128);
  bench.owner.log.clear();
  // Two of its own, then six of somebody else's flag: no dominant bit comes after that.
  bench.run("000000 11 000000 11111111 111");
  EXPECT_EQ(bench.counters(), "TEC 0, REC 129");
  bench.run(frame_wire + acknowledged);
  EXPECT_EQ(bench.owner.log, (Log{"receiving: stuff error", frame_text}));
}

// --- sending -------------------------------------------------------------------------------------

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
