#include <gtest/gtest.h>

#include <array>
#include <roio/candump_log.hpp>

#include "parsing.hpp"
#include "seed.hpp"

namespace roio {
namespace {

using test::Refusal;
using test::verdict;

Timestamp at_ns(std::int64_t ns) {
  return Timestamp(std::chrono::nanoseconds(ns));
}

std::string formatted(Timestamp time, std::string_view name, const Frame& frame) {
  std::array<char, max_log_line> line{};
  return {line.data(), format_log_line(line, time, name, frame)};
}

struct GoldenCase {
  const char* why;
  std::int64_t time_ns;
  std::string name;
  Frame frame;
  std::string line;
};

// Lines as candump 2020.11 prints them.
TEST(CandumpLog, WritesWhatCandumpPrints) {
  const GoldenCase cases[] = {
      {"standard",
       1436509052249713000,
       "vcan0",
       {0x123, FrameKind::standard, 2, {0x11, 0x22}},
       "(1436509052.249713) vcan0 123#1122\n"},
      {"extended",
       1436509052249713000,
       "vcan0",
       {0x1004A00A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}},
       "(1436509052.249713) vcan0 1004A00A#5A2D00\n"},
      {"remote",
       1436509052249713000,
       "can0",
       {0x123, FrameKind::standard_remote, 4, {}},
       "(1436509052.249713) can0 123#R4\n"},
      {"seconds in ten digits",
       0,
       "c",
       {0, FrameKind::extended_remote, 0, {}},
       "(0000000000.000000) c 00000000#R\n"},
      {"nanoseconds are cut off, not rounded",
       999999999,
       "c",
       {0, FrameKind::standard, 0, {}},
       "(0000000000.999999) c 000#\n"},
      {"before 1970", -1, "c", {0, FrameKind::standard, 0, {}}, "(0000000000.000000) c 000#\n"},
      {"the longest of all",
       INT64_MAX,
       std::string(70, 'n'),
       {0x1FFFFFFF, FrameKind::error, 8, {255, 255, 255, 255, 255, 255, 255, 255}},
       "(9223372036.854775) " + std::string(70, 'n') + " 3FFFFFFF#FFFFFFFFFFFFFFFF\n"},
      {"a longer name is cut off",
       0,
       std::string(71, 'n'),
       {0, FrameKind::standard, 0, {}},
       "(0000000000.000000) " + std::string(70, 'n') + " 000#\n"},
  };
  for (const GoldenCase& row : cases) {
    EXPECT_EQ(formatted(at_ns(row.time_ns), row.name, row.frame), row.line) << row.why;
  }
  EXPECT_EQ(cases[6].line.size(), max_log_line);
}

struct ReadCase {
  const char* why;
  const char* line;
  std::int64_t time_ns;
  const char* name;
  const char* frame;
};

TEST(CandumpLog, ReadsWhatCanplayerDoes) {
  const ReadCase cases[] = {
      {"as printed", "(1436509052.249713) vcan0 123#1122", 1436509052249713000, "vcan0",
       "123#1122"},
      {"line end", "(1436509052.249713) vcan0 123#1122\n", 1436509052249713000, "vcan0",
       "123#1122"},
      {"line end of another system", "(1436509052.249713) vcan0 123#1122\r\n", 1436509052249713000,
       "vcan0", "123#1122"},
      {"blanks at the end", "(1.5) can0 123# \t \n", 1500000000, "can0", "123#"},
      {"a padded name, as with several interfaces", "(1.5)   can0\t 123#R4", 1500000000, "can0",
       "123#R4"},
      {"received", "(1.5) can0 123#11 R", 1500000000, "can0", "123#11"},
      {"sent", "(1.5) can0 123#R T\n", 1500000000, "can0", "123#R"},
      {"one digit of a second", "(0.1) can0 123#", 100000000, "can0", "123#"},
      {"nine", "(0.123456789) can0 123#", 123456789, "can0", "123#"},
      {"the latest time", "(9223372036.854775807) can0 123#", INT64_MAX, "can0", "123#"},
      {"many leading zeros", "(00000000000000000000000000001.0) can0 123#", 1000000000, "can0",
       "123#"},
      {"a local bus", "(1.0) local:robot 1004A00A#", 1000000000, "local:robot", "1004A00A#"},
      {"a name with a hash", "(1.0) can#0 123#", 1000000000, "can#0", "123#"},
  };
  for (const ReadCase& row : cases) {
    const auto parsed = parse_log_line(row.line);
    ASSERT_EQ(verdict(parsed), "ok") << row.why;
    EXPECT_EQ(parsed->time, at_ns(row.time_ns)) << row.why;
    EXPECT_EQ(parsed->interface_name, row.name) << row.why;
    EXPECT_EQ(to_text(parsed->frame), row.frame) << row.why;
  }
}

TEST(CandumpLog, ATimeThatNobodyNeedsMayBeOfAnyForm) {
  for (const auto& [time, ns] : {
           std::pair{"1.5", std::int64_t{1500000000}},
           std::pair{"9223372036.854775807", INT64_MAX},
           std::pair{"9223372037.0", std::int64_t{0}},
           std::pair{"-0.250000", std::int64_t{0}},
           std::pair{"7", std::int64_t{0}},
           std::pair{"0.1234567890", std::int64_t{0}},
           std::pair{"", std::int64_t{0}},
           std::pair{"nan", std::int64_t{0}},
           std::pair{"2015-07-10 08:17:32.249713", std::int64_t{0}},
       }) {
    const std::string line = std::string("(") + time + ")  can0 123#1122 R\r\n";
    const auto parsed = parse_log_line_of_any_time(line);
    ASSERT_EQ(verdict(parsed), "ok") << line;
    EXPECT_EQ(parsed->time, at_ns(ns)) << line;
    EXPECT_EQ(parsed->interface_name, "can0") << line;
    EXPECT_EQ(to_text(parsed->frame), "123#1122") << line;
  }
  for (const char* line : {"", "1.5 can0 123#", "(1.5 can0 123#", "(1.5)can0 123#", "(1.5", "(7)",
                           "(7) can0", "(7) can0 123"}) {
    EXPECT_FALSE(parse_log_line_of_any_time(line).ok()) << line;
  }
}

void expect_refused(const Refusal& row) {
  const auto parsed = parse_log_line(row.text);
  ASSERT_EQ(verdict(parsed), "log line " + row.message) << row.why;
  EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
}

TEST(CandumpLog, TimeRefusedInWords) {
  const Refusal cases[] = {
      {"empty", "", R"("": empty; expected (SECONDS.FRACTION) INTERFACE FRAME)", 0},
      {"line end alone", "\n", R"("": empty; expected (SECONDS.FRACTION) INTERFACE FRAME)", 0},
      {"no parenthesis", "1.5 can0 123#",
       R"("1.5 can0 123#": no '(' at its start; expected (SECONDS.FRACTION) INTERFACE FRAME)", 0},
      {"a space first", " (1.5) can0 123#",
       R"(" (1.5) can0 123#": no '(' at its start; expected (SECONDS.FRACTION) INTERFACE FRAME)",
       0},
      {"what candump -d says of drops", "DROPCOUNT: dropped 1 CAN frame on 'can0' socket",
       R"("DROPCOUNT: dropped 1 CAN frame on 'can0' socket": )"
       R"(no '(' at its start; expected (SECONDS.FRACTION) INTERFACE FRAME)",
       0},
      {"not closed", "(1.5 can0 123#",
       R"("(1.5 can0 123#": no ')' after the time; expected (SECONDS.FRACTION))", 4},
      {"no space", "(1.5)can0 123#", R"("(1.5)can0 123#": "can0" after the time; expected a space)",
       5},
      {"no number", "() can0 123#",
       R"("() can0 123#": time ""; expected seconds, a dot and 1..9 digits, such as 0.250000)", 1},
      {"no fraction", "(15) can0 123#",
       R"("(15) can0 123#": time "15"; expected seconds, a dot and 1..9 digits, such as 0.250000)",
       1},
      {"no digit of it", "(15.) can0 123#",
       R"("(15.) can0 123#": time "15."; expected seconds, a dot and 1..9 digits, such as 0.250000)",
       1},
      {"ten digits of it", "(0.1234567890) can0 123#",
       R"("(0.1234567890) can0 123#": time "0.1234567890"; )"
       R"(expected seconds, a dot and 1..9 digits, such as 0.250000)",
       1},
      {"no seconds", "(.5) can0 123#",
       R"("(.5) can0 123#": time ".5"; expected seconds, a dot and 1..9 digits, such as 0.250000)",
       1},
      {"negative", "(-1.5) can0 123#",
       R"("(-1.5) can0 123#": time "-1.5"; )"
       R"(expected seconds, a dot and 1..9 digits, such as 0.250000)",
       1},
      {"a letter", "(1x.5) can0 123#",
       R"("(1x.5) can0 123#": time "1x.5"; )"
       R"(expected seconds, a dot and 1..9 digits, such as 0.250000)",
       1},
      {"a nanosecond too late", "(9223372036.854775808) can0 123#",
       R"("(9223372036.854775808) can0 123#": time "9223372036.854775808" is out of range; )"
       R"(expected at most 9223372036.854775807 s)",
       1},
      {"a second too late", "(9223372037.0) can0 123#",
       R"("(9223372037.0) can0 123#": time "9223372037.0" is out of range; )"
       R"(expected at most 9223372036.854775807 s)",
       1},
      {"past 64 bits", "(18446744073709551617.0) can0 123#",
       R"("(18446744073709551617.0) can0 123#": time "18446744073709551617.0" is out of range; )"
       R"(expected at most 9223372036.854775807 s)",
       1},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(CandumpLog, TheRestRefusedInWords) {
  const Refusal cases[] = {
      {"time alone", "(1.5)",
       R"x("(1.5)": no interface; expected (SECONDS.FRACTION) INTERFACE FRAME)x", 5},
      {"no frame", "(1.5) can0 ",
       R"("(1.5) can0 ": no frame; expected (SECONDS.FRACTION) INTERFACE FRAME)", 11},
      {"a name too long", "(1.5) " + std::string(71, 'n') + " 123#",
       R"("(1.5) nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn..." (82 bytes): )"
       R"(an interface name of 71 bytes; expected at most 70)",
       6},
      {"a zero byte in the name", std::string("(1.5) ca\0n 123#", 15),
       R"("(1.5) ca\x00n 123#": a control character in the interface name)", 8},
      {"odd digits", "(1.5) can0 123#112",
       R"("(1.5) can0 123#112": frame "123#112": odd number of hex digits; expected two per byte)",
       17},
      {"nine bytes", "(1.5) can0 123#112233445566778899",
       R"("(1.5) can0 123#112233445566778899": frame "123#112233445566778899": )"
       R"(9 bytes; a frame carries at most 8)",
       31},
      {"four digits", "(1.5) can0 1234#",
       R"("(1.5) can0 1234#": frame "1234#": )"
       R"(an identifier of 4 digits; expected 3 (standard) or 8 (extended))",
       11},
      {"remote for nine", "(1.5) can0 123#R9",
       R"("(1.5) can0 123#R9": frame "123#R9": )"
       R"(a remote request for 9 bytes; a frame carries at most 8)",
       16},
      {"CAN FD", "(1.5) can0 123##0112233",
       R"("(1.5) can0 123##0112233": frame "123##0112233": )"
       R"(a CAN FD frame ("##"); only classic CAN frames are taken)",
       14},
      {"more", "(1.5) can0 123# 456#",
       R"("(1.5) can0 123# 456#": "456#" after the frame; expected nothing more)", 16},
      {"more after the direction", "(1.5) can0 123# R x",
       R"("(1.5) can0 123# R x": "x" after the frame; expected nothing more)", 18},
      {"another line", "(1.5) can0 123#11\n(1.6) can0 123#22\n",
       R"x("(1.5) can0 123#11\n(1.6) can0 123#22": frame "123#11\n(1.6)": "\n" is no hex digit)x",
       17},
      {"a zero byte", std::string("(1.5) can0 123#\0", 16),
       R"("(1.5) can0 123#\x00": frame "123#\x00": "\x00" is no hex digit)", 15},
      {"a return within", "(1.5) can0 123#\r\r\n",
       R"("(1.5) can0 123#\r": frame "123#\r": "\r" is no hex digit)", 15},
      {"a megabyte", "(1.5) can0 123#" + std::string(1 << 20, 'A'),
       R"("(1.5) can0 123#AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA..." (1048591 bytes): )"
       R"(frame "123#AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA..." (1048580 bytes): )"
       R"(524288 bytes; a frame carries at most 8)",
       31},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

Frame random_frame(std::mt19937& generator) {
  constexpr FrameKind kinds[] = {FrameKind::standard, FrameKind::error, FrameKind::standard_remote,
                                 FrameKind::extended, FrameKind::extended_remote};
  Frame frame{};
  frame.kind = kinds[test::up_to(generator, 4)];
  frame.id = test::up_to(generator, max_id(frame.kind));
  frame.length = static_cast<std::uint8_t>(test::up_to(generator, max_data_length));
  for (std::uint8_t i = 0; i < frame.length && !is_remote(frame.kind); ++i) {
    frame.data[i] = static_cast<std::uint8_t>(test::up_to(generator, 0xFF));
  }
  return frame;
}

TEST(CandumpLog, RandomFramesComeBack) {
  std::mt19937 generator = test::seeded_generator();
  std::uniform_int_distribution<std::int64_t> any_us(0, INT64_MAX / 1000);
  for (int i = 0; i < 20000; ++i) {
    const Frame frame = random_frame(generator);
    const Timestamp time = at_ns(any_us(generator) * 1000);
    const std::string name(1 + test::up_to(generator, 69), 'n');
    const std::string line = formatted(time, name, frame);
    const auto parsed = parse_log_line(line);
    ASSERT_EQ(verdict(parsed), "ok") << line;
    EXPECT_EQ(parsed->time, time) << line;
    EXPECT_EQ(parsed->interface_name, name) << line;
    EXPECT_EQ(tagged_id(parsed->frame), tagged_id(frame)) << line;
    EXPECT_EQ(parsed->frame.length, frame.length) << line;
    EXPECT_TRUE(std::equal(frame.data, frame.data + 8, parsed->frame.data)) << line;
    EXPECT_EQ(formatted(parsed->time, parsed->interface_name, parsed->frame), line);
  }
}

}  // namespace
}  // namespace roio
