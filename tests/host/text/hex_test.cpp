#include <gtest/gtest.h>

#include <vector>

#include "parsing.hpp"

namespace roio {
namespace {

using test::Refusal;
using test::verdict;

std::vector<std::uint8_t> bytes_of(const Bytes& bytes) {
  return {bytes.data.begin(), bytes.data.begin() + bytes.length};
}

struct HexCase {
  const char* why;
  const char* text;
  std::vector<std::uint8_t> bytes;
};

TEST(HexText, IsReadAsCansendDoes) {
  const HexCase cases[] = {
      {"no data", "", {}},
      {"one byte", "5A", {0x5A}},
      {"lower case", "5a2dff", {0x5A, 0x2D, 0xFF}},
      {"dots between bytes", "5A.2D.00", {0x5A, 0x2D, 0x00}},
      {"spaces between bytes, as dump prints them", "5A 2D 00", {0x5A, 0x2D, 0x00}},
      {"a space between some, and a dot", "5A2D 00.01", {0x5A, 0x2D, 0x00, 0x01}},
      {"dots between some",
       "11.2233.44556677.88",
       {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}},
      {"eight bytes", "0001020304050607", {0, 1, 2, 3, 4, 5, 6, 7}},
  };
  for (const HexCase& row : cases) {
    const auto parsed = parse_hex(row.text);
    ASSERT_EQ(verdict(parsed), "ok") << row.why;
    EXPECT_EQ(bytes_of(*parsed), row.bytes) << row.why;
  }
}

TEST(HexText, IsWrittenInCapitals) {
  const std::uint8_t data[] = {0x00, 0x09, 0x0A, 0xAF, 0xFF};
  EXPECT_EQ(to_hex(data, 0), "");
  EXPECT_EQ(to_hex(data, 5), "00090AAFFF");
}

TEST(HexText, EveryByteComesBack) {
  for (int value = 0; value <= 0xFF; ++value) {
    const auto byte = static_cast<std::uint8_t>(value);
    const auto parsed = parse_hex(to_hex(&byte, 1));
    ASSERT_EQ(verdict(parsed), "ok");
    EXPECT_EQ(bytes_of(*parsed), std::vector<std::uint8_t>{byte});
  }
}

TEST(HexText, RefusedInWords) {
  const Refusal cases[] = {
      {"odd", "5A2", R"(data "5A2": odd number of hex digits; expected two per byte)", 2},
      {"one digit", "5", R"(data "5": odd number of hex digits; expected two per byte)", 0},
      {"odd before a dot", "5.A2",
       R"(data "5.A2": odd number of hex digits; expected two per byte)", 0},
      {"nine bytes", "112233445566778899",
       R"(data "112233445566778899": 9 bytes; a frame carries at most 8)", 16},
      {"ten, with dots", "00.11.22.33.44.55.66.77.88.99",
       R"(data "00.11.22.33.44.55.66.77.88.99": 10 bytes; a frame carries at most 8)", 24},
      {"no hex digit first", "G0", R"(data "G0": "G" is no hex digit)", 0},
      {"no hex digit second", "0G", R"(data "0G": "G" is no hex digit)", 1},
      {"a prefix", "0x5A", R"(data "0x5A": "x" is no hex digit)", 1},
      {"a space within a byte", "5 A",
       R"(data "5 A": odd number of hex digits; expected two per byte)", 0},
      {"two spaces", "5A  2D", R"(data "5A  2D": " " is no hex digit)", 3},
      {"a space first", " 5A", R"(data " 5A": " " is no hex digit)", 0},
      {"a space last", "5A ",
       R"(data "5A ": a space after the last byte; spaces stand between bytes)", 2},
      {"a minus", "-1", R"(data "-1": "-" is no hex digit)", 0},
      {"a line end", "5A\n", R"(data "5A\n": "\n" is no hex digit)", 2},
      {"beyond ASCII", "\xC3\xA4", R"(data "ä": "\xC3" is no hex digit)", 0},
      {"two dots", "5A..2D",
       R"(data "5A..2D": a dot where a byte was expected; dots stand between bytes)", 3},
      {"leading dot", ".5A",
       R"(data ".5A": a dot where a byte was expected; dots stand between bytes)", 0},
      {"trailing dot", "5A.", R"(data "5A.": a dot after the last byte; dots stand between bytes)",
       2},
      {"very long", std::string(2000000, '0'),
       R"(data "000000000000000000000000000000000000000000000000..." (2000000 bytes): )"
       R"(1000000 bytes; a frame carries at most 8)",
       16},
  };
  for (const Refusal& row : cases) {
    const auto parsed = parse_hex(row.text);
    ASSERT_EQ(verdict(parsed), row.message) << row.why;
    EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
  }
}

}  // namespace
}  // namespace roio
