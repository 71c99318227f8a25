// A controller that receives, and what it counts.
#include "controller_bench.hpp"

namespace roio::sim {
namespace {

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
const Log stuff = {"receiving: stuff error"};
const Log stuff_bit = {"receiving: stuff error", "receiving: bit error"};
const Log stuff_form = {"receiving: stuff error", "receiving: form error"};
const std::string received = frame_wire + "1 0 1 1111111";

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

}  // namespace
}  // namespace roio::sim
