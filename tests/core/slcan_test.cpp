// SLCAN: lines out of bytes, commands out of lines, and text out of frames. Whole lines are
// compared, as LAWICEL's manuals, slcand, python-can and SavvyCAN write them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <random>
#include <roio/slcan.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "seed.hpp"

namespace roio::slcan {
namespace {

using Event = LineReader::Event;
using Kind = Command::Kind;

Command parse(std::string_view text) {
  // Of its very size, so that AddressSanitizer sees a read past its end.
  const std::vector<char> line(text.begin(), text.end());
  return slcan::parse(line.data(), static_cast<std::uint8_t>(line.size()));
}

Frame frame_of(FrameKind kind, std::uint32_t id, std::vector<std::uint8_t> data) {
  Frame frame{};
  frame.kind = kind;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data);
  return frame;
}

Frame remote(FrameKind kind, std::uint32_t id, std::uint8_t length) {
  Frame frame{};
  frame.kind = kind;
  frame.id = id;
  frame.length = length;
  return frame;
}

void expect_same(const Frame& got, const Frame& expected, const char* why) {
  EXPECT_EQ(got.kind, expected.kind) << why;
  EXPECT_EQ(got.id, expected.id) << why;
  EXPECT_EQ(got.length, expected.length) << why;
  EXPECT_TRUE(std::equal(got.data, got.data + max_data_length, expected.data)) << why;
}

/// What a formatter writes, which must leave alone what comes after it.
template <typename Format>
std::string written(Format format) {
  std::array<char, max_line + 1> line{};
  line.fill('#');
  const std::uint8_t length = format(line.data());
  EXPECT_LE(length, max_line);
  EXPECT_EQ(std::string(line.begin() + length, line.end()), std::string(line.size() - length, '#'));
  return {line.begin(), line.begin() + length};
}

std::string text_of(const Frame& frame) {
  return written([&](char* line) { return format_frame(frame, line); });
}
std::string text_of(const Frame& frame, std::uint16_t time_ms) {
  return written([&](char* line) { return format_frame(frame, time_ms, line); });
}

// --- lines ---------------------------------------------------------------------------------------

/// What ends in a stream: each line between quotes, or what it was.
std::vector<std::string> ended(std::string_view stream) {
  std::vector<std::string> all;
  LineReader reader;
  for (const char byte : stream) {
    switch (reader.take(static_cast<std::uint8_t>(byte))) {
      case Event::none:
        break;
      case Event::line:
        all.push_back("'" + std::string(reader.text(), reader.length()) + "'");
        break;
      case Event::bad:
        all.emplace_back("bad");
        break;
      case Event::noise:
        all.emplace_back("noise");
        break;
    }
  }
  return all;
}

TEST(SlcanLine, EndsAtCr) {
  using Ends = std::vector<std::string>;
  using namespace std::string_view_literals;
  struct Case {
    const char* why;
    std::string_view stream;
    Ends ends;
  };
  const Case cases[] = {
      {"a command", "O\r"sv, {"'O'"}},
      {"not before its CR", "O"sv, {}},
      {"what slcand -c -s6 -o sends", "C\rS6\rO\r"sv, {"'C'", "'S6'", "'O'"}},
      {"what is sent to be rid of half a command", "\r\r\r"sv, {"''", "''", "''"}},
      {"CR LF, of a terminal", "V\r\nN\r\n"sv, {"'V'", "'N'"}},
      {"LF alone ends nothing", "V\nN\r"sv, {"'V\nN'"}},
      {"the longest", "T1FFFFFFF80011223344556677\r"sv, {"'T1FFFFFFF80011223344556677'"}},
      {"one more", "T1FFFFFFF800112233445566778\rO\r"sv, {"bad", "'O'"}},
      {"far too long is bad once",
       "T1FFFFFFF8001122334455667700112233445566770011223344556677\rO\r"sv,
       {"bad", "'O'"}},
      {"a zero starts over", "t12\0O\r"sv, {"'O'"}},
      {"after too much also", "T1FFFFFFF800112233445566778\0O\r"sv, {"'O'"}},
      {"a HELLO with a CR in it is no command",
       "\x02\xE1\x0A\x01\x52\r\x01\x49\x98\0O\r"sv,
       {"noise", "'O'"}},
      {"after it, without its zero", "\x02\xE1\rO\r"sv, {"noise", "'O'"}},
      {"no letter: a space", " O\r"sv, {"noise"}},
      {"no letter: past the tilde", "\x7FO\r"sv, {"noise"}},
      {"the first and the last that are printed", "!\r~\r"sv, {"'!'", "'~'"}},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(ended(one.stream), one.ends) << one.why;
  }
}

TEST(SlcanLine, ResetForgetsWhatHasBegun) {
  LineReader reader;
  reader.take('t');
  reader.reset();
  reader.take('V');
  ASSERT_EQ(reader.take('\r'), Event::line);
  EXPECT_EQ(std::string(reader.text(), reader.length()), "V");
}

// --- commands ------------------------------------------------------------------------------------

TEST(SlcanCommand, SaysWhatIsAsked) {
  struct Case {
    const char* why;
    std::string_view text;
    Kind kind;
    std::uint32_t bitrate_bps = 0;
    std::uint16_t sample_point = 875;
  };
  const Case cases[] = {
      {"open", "O", Kind::open},
      {"listen only", "L", Kind::listen},
      {"close", "C", Kind::close},
      {"10 kbit/s", "S0", Kind::bitrate, 10'000},
      {"20 kbit/s", "S1", Kind::bitrate, 20'000},
      {"50 kbit/s", "S2", Kind::bitrate, 50'000},
      {"100 kbit/s", "S3", Kind::bitrate, 100'000},
      {"125 kbit/s", "S4", Kind::bitrate, 125'000},
      {"250 kbit/s", "S5", Kind::bitrate, 250'000},
      {"500 kbit/s", "S6", Kind::bitrate, 500'000},
      {"800 kbit/s", "S7", Kind::bitrate, 800'000, 800},
      {"1 Mbit/s", "S8", Kind::bitrate, 1'000'000, 750},
      {"python-can's S9", "S9", Kind::bitrate, 83'333},
      {"one before S0: a rate that is none", "S/", Kind::bitrate, 0},
      {"no decimal digit", "SA", Kind::bitrate, 0},
      {"S without a number", "S", Kind::bitrate, 0},
      {"S with two", "S66", Kind::bitrate, 0},
      {"registers of an SJA1000, 4 x 16", "s031C", Kind::bitrate, 125'000, 875},
      {"jump and triple sampling are not looked at", "sC39C", Kind::bitrate, 125'000, 875},
      {"6 x 16", "s051c", Kind::bitrate, 83'333, 875},
      {"the slowest: 64 x 25", "s3F7F", Kind::bitrate, 5'000, 680},
      {"the fastest, which no controller makes", "s0000", Kind::bitrate, 2'666'666, 666},
      {"s with a digit too few", "s031", Kind::bitrate, 0},
      {"with one too many", "s031C0", Kind::bitrate, 0},
      {"with what is no digit", "s031G", Kind::bitrate, 0},
      {"flags", "F", Kind::flags},
      {"version", "V", Kind::version},
      {"number", "N", Kind::serial_number},
      {"times off", "Z0", Kind::times_off},
      {"times on", "Z1", Kind::times_on},
      {"others' Z2, longer times", "Z2", Kind::bad},
      {"Z without a number", "Z", Kind::bad},
      {"frames unasked, which they are", "X1", Kind::no_change},
      {"frames only when polled", "X0", Kind::bad},
      {"all codes pass", "M00000000", Kind::no_change},
      {"with another code", "M00000001", Kind::bad},
      {"under the mask that lets all pass", "mFFFFFFFF", Kind::no_change},
      {"in small digits", "mffffffff", Kind::no_change},
      {"under another mask", "mFFFFFFFE", Kind::bad},
      {"the code as a mask", "m00000000", Kind::bad},
      {"the mask as a code", "MFFFFFFFF", Kind::bad},
      {"a digit short", "M0000000", Kind::bad},
      {"a digit more", "M000000000", Kind::bad},
      {"no digit among them", "M0000000G", Kind::bad},
      {"nothing, of CR CR", "", Kind::empty},
      {"no such letter", "Q", Kind::bad},
      {"small letters are others", "o", Kind::bad},
      {"more than a letter", "O1", Kind::bad},
      {"a command twice", "OO", Kind::bad},
      {"poll, of before frames came unasked", "P", Kind::bad},
      {"a letter past ASCII", "\xCF", Kind::bad},
  };
  for (const Case& one : cases) {
    const Command command = parse(one.text);
    EXPECT_EQ(command.kind, one.kind) << one.why;
    EXPECT_EQ(command.bitrate_bps, one.bitrate_bps) << one.why;
    if (one.bitrate_bps != 0) {
      EXPECT_EQ(command.sample_point_permille, one.sample_point) << one.why;
    }
  }
}

TEST(SlcanCommand, FramesAsTheyAreSent) {
  using enum FrameKind;
  struct Case {
    const char* why;
    std::string_view text;
    Frame frame;
  };
  const Case cases[] = {
      {"of the manual", "t10021133", frame_of(standard, 0x100, {0x11, 0x33})},
      {"of the manual, no data", "t0200", frame_of(standard, 0x020, {})},
      {"of the manual, extended", "T0000010021133", frame_of(extended, 0x100, {0x11, 0x33})},
      {"of the manual, remote", "r1002", remote(standard_remote, 0x100, 2)},
      {"of the manual, extended remote", "R000001002", remote(extended_remote, 0x100, 2)},
      {"the highest of 11 bits", "t7FF0", frame_of(standard, 0x7FF, {})},
      {"the highest of 29 bits", "T1FFFFFFF0", frame_of(extended, 0x1FFFFFFF, {})},
      {"eight bytes", "t12380011223344556677",
       frame_of(standard, 0x123, {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77})},
      {"eight bytes, extended", "T12ABCDEF888FF99AABBCCDDEE",
       frame_of(extended, 0x12ABCDEF, {0x88, 0xFF, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE})},
      {"small digits", "t7ab2cdef", frame_of(standard, 0x7AB, {0xCD, 0xEF})},
      {"small digits, extended", "T1abcdef01fa", frame_of(extended, 0x1ABCDEF0, {0xFA})},
      {"remote of nothing", "r0000", remote(standard_remote, 0, 0)},
      {"remote of eight", "R1FFFFFFF8", remote(extended_remote, 0x1FFFFFFF, 8)},
      {"extended as SavvyCAN sends it, bit 31 set", "T92ABCDEF15A",
       frame_of(extended, 0x12ABCDEF, {0x5A})},
  };
  for (const Case& one : cases) {
    const Command command = parse(one.text);
    ASSERT_EQ(command.kind, Kind::frame) << one.why;
    expect_same(command.frame, one.frame, one.why);
  }
}

TEST(SlcanCommand, WhatIsNoFrameIsBad) {
  struct Case {
    const char* why;
    std::string_view text;
  };
  const Case cases[] = {
      {"a letter", "t"},
      {"no length", "t123"},
      {"no length, extended", "T12345678"},
      {"no length, remote", "r123"},
      {"past 11 bits", "t8000"},
      {"past 11 bits, remote", "r8000"},
      {"past 29 bits", "T200000000"},
      {"past 29 bits, remote", "R200000000"},
      {"past 29 bits and bit 31", "TA00000000"},
      {"length 9", "t12390011223344556677"},
      {"length 9 and as many bytes as fit", "t1239001122334455667788"},
      {"length A", "t123A0011223344556677"},
      {"length 9, remote", "r1239"},
      {"length 9, extended remote", "R000001239"},
      {"a byte short", "t123211"},
      {"half a byte short", "t1232112"},
      {"half a byte more", "t12321122F"},
      {"a byte more", "t12310011"},
      {"data of a length 0", "t123000"},
      {"data of a remote frame", "r123111"},
      {"no digit in the identifier", "t1G30"},
      {"one before 0", "t1/30"},
      {"one after 9", "t1:30"},
      {"one before A", "t1@30"},
      {"one before a", "t1`30"},
      {"one after f", "t1g30"},
      {"a sign", "t-120"},
      {"a space", "t 120"},
      {"no digit for the length", "t123."},
      {"no digit in the data", "t12311x"},
      {"no digit that ends the data", "t12311\n"},
      {"not in ASCII", "t12311\xB1"},
      {"a time, which only adapters send", "t12301234"},
      {"of CAN FD", "d1230"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(parse(one.text).kind, Kind::bad) << one.why;
  }
}

TEST(SlcanCommand, EveryIdentifierOf3DigitsIsReadOrRefused) {
  for (std::uint32_t id = 0; id <= 0xFFF; ++id) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "t%03X0", id);
    const Command command = parse(text.data());
    ASSERT_EQ(command.kind, id <= 0x7FF ? Kind::frame : Kind::bad) << text.data();
    ASSERT_TRUE(id > 0x7FF || command.frame.id == id) << text.data();
  }
}

// --- text ----------------------------------------------------------------------------------------

TEST(SlcanText, FramesAsTheyAreRead) {
  using enum FrameKind;
  const std::vector<std::uint8_t> eight = {0x00, 0x11, 0x22, 0x9A, 0xAB, 0xBC, 0xCD, 0xFF};
  struct Case {
    const char* why;
    Frame frame;
    std::string text;
  };
  const Case cases[] = {
      {"no data", frame_of(standard, 0x123, {}), "t1230\r"},
      {"as in the kernel's text", frame_of(standard, 0x456, {0x11, 0x22, 0x33}), "t4563112233\r"},
      {"the same, extended", frame_of(extended, 0x12ABCDEF, {0xAA, 0x55}), "T12ABCDEF2AA55\r"},
      {"the same, remote", remote(standard_remote, 0x123, 0), "r1230\r"},
      {"zeros in front", frame_of(standard, 1, {1}), "t001101\r"},
      {"zeros in front, extended", frame_of(extended, 1, {1}), "T00000001101\r"},
      {"the highest", frame_of(standard, 0x7FF, eight), "t7FF80011229AABBCCDFF\r"},
      {"the longest", frame_of(extended, 0x1FFFFFFF, eight), "T1FFFFFFF80011229AABBCCDFF\r"},
      {"remote: a length, and no data", remote(standard_remote, 0x7FF, 8), "r7FF8\r"},
      {"remote, extended", remote(extended_remote, 0x1FFFFFFF, 8), "R1FFFFFFF8\r"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(text_of(one.frame), one.text) << one.why;
  }
}

TEST(SlcanText, TimesComeLast) {
  using enum FrameKind;
  EXPECT_EQ(text_of(frame_of(standard, 0x100, {0x11, 0x33}), 0), "t100211330000\r");
  EXPECT_EQ(text_of(frame_of(standard, 0x100, {}), 0x0C1D), "t10000C1D\r");
  EXPECT_EQ(text_of(remote(extended_remote, 0x100, 2), 59'999), "R000001002EA5F\r");
  const Frame longest =
      frame_of(extended, 0x11112222, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88});
  const std::string text = text_of(longest, time_span_ms - 1);
  EXPECT_EQ(text, "T1111222281122334455667788EA5F\r") << "the longest that Linux has room for";
  EXPECT_EQ(text.size(), max_line);
}

TEST(SlcanText, Answers) {
  EXPECT_EQ(written([](char* line) { return format_flags(0, line); }), "F00\r");
  EXPECT_EQ(written([](char* line) {
              return format_flags(receive_full | error_warning | error_passive | bus_error, line);
            }),
            "FA5\r");
  EXPECT_EQ(written([](char* line) { return format_flags(transmit_full | overrun, line); }),
            "F0A\r");
  EXPECT_EQ(written([](char* line) { return format_about('V', "1013", line); }), "V1013\r");
  EXPECT_EQ(written([](char* line) { return format_about('N', "A123", line); }), "NA123\r");
  EXPECT_EQ(taken(FrameKind::standard), 'z');
  EXPECT_EQ(taken(FrameKind::standard_remote), 'z');
  EXPECT_EQ(taken(FrameKind::extended), 'Z');
  EXPECT_EQ(taken(FrameKind::extended_remote), 'Z');
  EXPECT_EQ(ok, 13);
  EXPECT_EQ(error, 7);
}

TEST(SlcanText, AnyFrameComesBack) {
  std::mt19937 random = test::seeded_generator();
  const FrameKind kinds[] = {FrameKind::standard, FrameKind::standard_remote, FrameKind::extended,
                             FrameKind::extended_remote};
  for (int run = 0; run < 20'000; ++run) {
    Frame frame{};
    frame.kind = kinds[test::up_to(random, 3)];
    frame.id = test::up_to(random, max_id(frame.kind));
    frame.length = static_cast<std::uint8_t>(test::up_to(random, 8));
    for (std::uint8_t i = 0; i < frame.length && !is_remote(frame.kind); ++i) {
      frame.data[i] = static_cast<std::uint8_t>(random());
    }
    LineReader reader;
    Event event = Event::none;
    const std::string text = text_of(frame);
    for (const char byte : text) {
      ASSERT_EQ(event, Event::none);
      event = reader.take(static_cast<std::uint8_t>(byte));
    }
    ASSERT_EQ(event, Event::line) << text;
    const Command command = slcan::parse(reader.text(), reader.length());
    ASSERT_EQ(command.kind, Kind::frame) << text;
    expect_same(command.frame, frame, text.c_str());
  }
}

}  // namespace
}  // namespace roio::slcan
