#include <gtest/gtest.h>

#include <roio/candump_log.hpp>

#include "parsing.hpp"

namespace roio {
namespace {

using test::Refusal;
using test::verdict;

bool same(const Frame& a, const Frame& b) {
  return tagged_id(a) == tagged_id(b) && a.length == b.length &&
         (is_remote(a.kind) || std::equal(a.data, a.data + a.length, b.data));
}

struct FrameCase {
  const char* why;
  const char* text;
  Frame frame;
  const char* written;  ///< As candump -L prints it.
};

// The texts are what cansend 2020.11 takes; `written` is what its peer candump prints.
TEST(FrameText, IsReadAndWritten) {
  const FrameCase cases[] = {
      {"standard", "123#1122", {0x123, FrameKind::standard, 2, {0x11, 0x22}}, "123#1122"},
      {"no data", "123#", {0x123, FrameKind::standard, 0, {}}, "123#"},
      {"largest standard", "7FF#00", {0x7FF, FrameKind::standard, 1, {0}}, "7FF#00"},
      {"leading zeros", "001#", {1, FrameKind::standard, 0, {}}, "001#"},
      {"extended by its eight digits",
       "00000123#5A",
       {0x123, FrameKind::extended, 1, {0x5A}},
       "00000123#5A"},
      {"largest extended", "1FFFFFFF#", {0x1FFFFFFF, FrameKind::extended, 0, {}}, "1FFFFFFF#"},
      {"a Roio message",
       "1004A00A#5A2D00",
       {0x1004A00A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}},
       "1004A00A#5A2D00"},
      {"lower case",
       "7ff#abcdef",
       {0x7FF, FrameKind::standard, 3, {0xAB, 0xCD, 0xEF}},
       "7FF#ABCDEF"},
      {"dots",
       "5A1#11.2233.44556677.88",
       {0x5A1, FrameKind::standard, 8, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}},
       "5A1#1122334455667788"},
      {"outer dots, which cansend takes",
       "5A1#.11.22.",
       {0x5A1, FrameKind::standard, 2, {0x11, 0x22}},
       "5A1#1122"},
      {"a dot alone, which cansend takes", "5A1#.", {0x5A1, FrameKind::standard, 0, {}}, "5A1#"},
      {"remote", "123#R", {0x123, FrameKind::standard_remote, 0, {}}, "123#R"},
      {"remote, lower case", "123#r3", {0x123, FrameKind::standard_remote, 3, {}}, "123#R3"},
      {"remote for nothing", "123#R0", {0x123, FrameKind::standard_remote, 0, {}}, "123#R"},
      {"remote for eight", "123#R8", {0x123, FrameKind::standard_remote, 8, {}}, "123#R8"},
      {"extended remote", "00000123#R3", {0x123, FrameKind::extended_remote, 3, {}}, "00000123#R3"},
      {"a length code above 8, which means 8",
       "123#1122334455667788_E",
       {0x123, FrameKind::standard, 8, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}},
       "123#1122334455667788"},
      {"the smallest such, with dots",
       "1004A00A#11.22.33.44.55.66.77.88_9",
       {0x1004A00A, FrameKind::extended, 8, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}},
       "1004A00A#1122334455667788"},
      {"such a remote request", "123#R8_f", {0x123, FrameKind::standard_remote, 8, {}}, "123#R8"},
      {"error report",
       "20000004#0001000000000000",
       {0x004, FrameKind::error, 8, {0, 1, 0, 0, 0, 0, 0, 0}},
       "20000004#0001000000000000"},
      {"largest error report", "3FFFFFFF#", {0x1FFFFFFF, FrameKind::error, 0, {}}, "3FFFFFFF#"},
  };
  for (const FrameCase& row : cases) {
    const auto parsed = parse_frame_text(row.text);
    ASSERT_EQ(verdict(parsed), "ok") << row.why;
    EXPECT_TRUE(same(*parsed, row.frame)) << row.why << ": " << to_text(*parsed);
    EXPECT_EQ(to_text(*parsed), row.written) << row.why;
  }
}

TEST(FrameText, RefusedInWords) {
  const Refusal cases[] = {
      {"empty", "", R"("": no '#'; expected ID#DATA, such as 1004A00A#5A2D00)", 0},
      {"no hash", "123", R"("123": no '#'; expected ID#DATA, such as 1004A00A#5A2D00)", 3},
      {"no identifier", "#11",
       R"("#11": an identifier of 0 digits; expected 3 (standard) or 8 (extended))", 0},
      {"two digits", "12#11",
       R"("12#11": an identifier of 2 digits; expected 3 (standard) or 8 (extended))", 0},
      {"a length code after fewer bytes", "123#1122_E",
       R"("123#1122_E": length code "_E" with 2 bytes; expected it with 8 only)", 8},
      {"a length code after a shorter request", "123#R_F",
       R"("123#R_F": length code "_F" with 0 bytes; expected it with 8 only)", 5},
      {"a length code that is a length", "123#1122334455667788_8",
       R"("123#1122334455667788_8": "_" is no hex digit)", 20},
      {"a length code of two digits", "123#1122334455667788_0E",
       R"("123#1122334455667788_0E": "_" is no hex digit)", 20},
      {"half a length code", "123#1122334455667788_",
       R"("123#1122334455667788_": "_" is no hex digit)", 20},
      {"four digits", "1234#11",
       R"("1234#11": an identifier of 4 digits; expected 3 (standard) or 8 (extended))", 0},
      {"nine digits", "123456789#11",
       R"("123456789#11": an identifier of 9 digits; expected 3 (standard) or 8 (extended))", 0},
      {"above 11 bits", "800#11", R"("800#11": identifier 800 is out of range; expected 000..7FF)",
       0},
      {"above an error report's", "40000000#",
       R"("40000000#": identifier 40000000 is out of range; )"
       R"(expected 00000000..1FFFFFFF, or 20000000..3FFFFFFF for an error report)",
       0},
      {"all ones", "FFFFFFFF#",
       R"("FFFFFFFF#": identifier FFFFFFFF is out of range; )"
       R"(expected 00000000..1FFFFFFF, or 20000000..3FFFFFFF for an error report)",
       0},
      {"no hex digit", "12G#", R"("12G#": "G" is no hex digit of an identifier)", 2},
      {"odd digits", "123#112", R"("123#112": odd number of hex digits; expected two per byte)", 6},
      {"nine bytes, of which cansend sends eight", "123#112233445566778899",
       R"("123#112233445566778899": 9 bytes; a frame carries at most 8)", 20},
      {"two dots", "123#11..22",
       R"("123#11..22": a dot where a byte was expected; dots stand between bytes)", 7},
      {"two dots and nothing", "123#..",
       R"("123#..": a dot where a byte was expected; dots stand between bytes)", 5},
      {"CAN FD", "123##1112233",
       R"("123##1112233": a CAN FD frame ("##"); only classic CAN frames are taken)", 3},
      {"CAN XL", "45123#81:00:12345678#11223344.556677",
       R"("45123#81:00:12345678#11223344.556677": a CAN XL frame; only classic CAN frames are taken)",
       5},
      {"remote for nine", "123#R9",
       R"("123#R9": a remote request for 9 bytes; a frame carries at most 8)", 5},
      {"text after R", "123#R4x",
       R"("123#R4x": "4x" after R; expected the length asked for, 0..8, or nothing)", 5},
      {"a hex digit after R", "123#RA",
       R"("123#RA": "A" after R; expected the length asked for, 0..8, or nothing)", 5},
      {"remote error report", "20000004#R",
       R"("20000004#R": an error report is never a remote request)", 9},
      {"a line end", "123#11\n", R"("123#11\n": "\n" is no hex digit)", 6},
      {"a zero byte", std::string("123#\0", 5), R"("123#\x00": "\x00" is no hex digit)", 4},
  };
  for (const Refusal& row : cases) {
    const auto parsed = parse_frame_text(row.text);
    ASSERT_EQ(verdict(parsed), "frame " + row.message) << row.why;
    EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
  }
}

// Not what a bus carries, so cut down rather than written past the end of anything.
TEST(FrameText, InvalidFramesAreCutDown) {
  EXPECT_EQ(to_text(Frame{0xFFF, FrameKind::standard, 0, {}}), "7FF#");
  EXPECT_EQ(to_text(Frame{0xFFFFFFFF, FrameKind::extended, 0, {}}), "1FFFFFFF#");
  EXPECT_EQ(to_text(Frame{1, FrameKind::standard, 255, {1, 2, 3, 4, 5, 6, 7, 8}}),
            "001#0102030405060708");
}

}  // namespace
}  // namespace roio
