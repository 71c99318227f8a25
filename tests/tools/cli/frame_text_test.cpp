#include "form/frame_text.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <ostream>
#include <roio/message.hpp>
#include <string>

namespace roio::cli {
namespace {

std::string line(const Frame& frame, Colour colour = Colour::none, Gap gap = Gap::wide) {
  Buffer out;
  append_frame(out, frame, colour, gap);
  return {out.data(), out.size()};
}

// Identifiers worked by hand from docs/protocol.md "Header".
constexpr std::uint32_t from_0_10_to_0_2 = 0x1000400A;

struct Row {
  const char* name;
  Frame frame;
  const char* text;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.name;
}

class FrameText : public testing::TestWithParam<Row> {};

TEST_P(FrameText, IsThisLine) {
  EXPECT_EQ(line(GetParam().frame), GetParam().text);
}

INSTANTIATE_TEST_SUITE_P(
    All, FrameText,
    testing::Values(
        Row{"Message",
            {from_0_10_to_0_2, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}},
            "0.10   -> 0.2     normal  message  [3]  5A 2D 00"},
        Row{"WidestEverything",
            {0x07FFDFFE, FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 0xFF}},
            "31.254 -> 31.254  urgent  system   [8]  01 02 03 04 05 06 07 FF"},
        Row{"BroadcastOfNoBytesHasNoSpacesAtItsEnd",
            {0x181FE003, FrameKind::extended, 0, {}},
            "0.3    -> 0.*     normal  stream   [0]"},
        Row{"Standard",
            {0x123, FrameKind::standard, 2, {0x11, 0x22}},
            "foreign  11-bit 123                [2]  11 22"},
        Row{"StandardRemote",
            {0x7FF, FrameKind::standard_remote, 4, {}},
            "foreign  11-bit 7FF                [4]  remote request"},
        Row{"ExtendedRemote",
            {from_0_10_to_0_2, FrameKind::extended_remote, 0, {}},
            "foreign  29-bit 1000400A           [0]  remote request"},
        Row{"ReservedClass",
            {0x1C00400A, FrameKind::extended, 1, {0xAB}},
            "foreign  29-bit 1C00400A           [1]  AB  (reserved class)"},
        Row{"BroadcastAsSource",
            {0x100040FF, FrameKind::extended, 1, {0xAB}},
            "foreign  29-bit 100040FF           [1]  AB  (broadcast as source)"},
        Row{"ErrorReport",
            {0x44, FrameKind::error, 8, {0, 8, 0, 0, 0, 0, 0, 0}},
            "error    00000044                  [8]  00 08 00 00 00 00 00 00  controller, bus-off"},
        Row{"LastErrorClass",
            {0x100, FrameKind::error, 0, {}},
            "error    00000100                  [0]  restarted"}),
    [](const auto& row) { return row.param.name; });

TEST(FrameText, ColumnsLineUpWhateverTheFrame) {
  for (const Gap gap : {Gap::wide, Gap::narrow}) {
    const std::size_t column = line({0, FrameKind::extended, 1, {1}}, Colour::none, gap).find('[');
    for (const FrameKind kind : {FrameKind::standard, FrameKind::standard_remote,
                                 FrameKind::extended_remote, FrameKind::error}) {
      EXPECT_EQ(line({0x7FF, kind, 1, {1}}, Colour::none, gap).find('['), column);
    }
  }
}

TEST(FrameText, NarrowColumnsStandOneSpaceApart) {
  EXPECT_EQ(
      line({from_0_10_to_0_2, FrameKind::extended, 2, {0x5A, 0x2D}}, Colour::none, Gap::narrow),
      "0.10   -> 0.2    normal message [2] 5A 2D");
  EXPECT_EQ(line({0x123, FrameKind::standard, 2, {0x11, 0x22}}, Colour::none, Gap::narrow),
            "foreign 11-bit 123              [2] 11 22");
  EXPECT_EQ(line({0x7FF, FrameKind::standard_remote, 4, {}}, Colour::none, Gap::narrow),
            "foreign 11-bit 7FF              [4] remote request");
}

// A terminal has 80 columns, and so has help.
TEST(FrameText, TheWidestMessageFitsBesideEveryTime) {
  const Frame widest{0x07FFDFFE, FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 0xFF}};
  for (const auto mode : {TimeColumn::Mode::none, TimeColumn::Mode::absolute,
                          TimeColumn::Mode::delta, TimeColumn::Mode::zero}) {
    TimeColumn time(mode);
    Buffer out;
    time.append(out, Timestamp(std::chrono::nanoseconds(1436509052'249713'999)));
    append_frame(out, widest, Colour::none, time.gap());
    EXPECT_LE(out.size(), 80U) << std::string(out.data(), out.size());
  }
}

TEST(FrameText, ColourMarksUrgentForeignAndErrorsAndNothingElse) {
  const Frame normal{from_0_10_to_0_2, FrameKind::extended, 0, {}};
  EXPECT_EQ(line(normal, Colour::kinds), line(normal));
  EXPECT_EQ(line({0x0000400A, FrameKind::extended, 0, {}}, Colour::kinds),
            "\033[1;33m0.10   -> 0.2     urgent  message  [0]\033[0m");
  EXPECT_EQ(line({0x123, FrameKind::standard, 0, {}}, Colour::kinds),
            "\033[2mforeign  11-bit 123                [0]\033[0m");
  EXPECT_EQ(line({0x40, FrameKind::error, 0, {}}, Colour::kinds),
            "\033[31merror    00000040                  [0]  bus-off\033[0m");
}

TEST(FrameText, ColourBySourceIsTheSourcesAndUrgentIsBold) {
  const auto from = [](std::uint32_t node) {
    return line({0x10004000 + node, FrameKind::extended, 0, {}}, Colour::sources);
  };
  EXPECT_EQ(from(10), "\033[33m0.10   -> 0.2     normal  message  [0]\033[0m");
  EXPECT_EQ(line({0x0000400A, FrameKind::extended, 0, {}}, Colour::sources),
            "\033[33m\033[1m0.10   -> 0.2     urgent  message  [0]\033[0m");
  for (std::uint32_t node = 1; node < 255; ++node) {
    EXPECT_NE(from(node).substr(0, 5), from(node - 1).substr(0, 5)) << node;
  }
  EXPECT_EQ(line({0x123, FrameKind::standard, 0, {}}, Colour::sources),
            "\033[2mforeign  11-bit 123                [0]\033[0m");
}

TEST(FrameText, RoioIsAnExtendedDataFrameOfAKnownClassFromANode) {
  EXPECT_TRUE(is_roio({from_0_10_to_0_2, FrameKind::extended, 0, {}}));
  EXPECT_FALSE(is_roio({0x1C00400A, FrameKind::extended, 0, {}}));
  EXPECT_FALSE(is_roio({0x100040FF, FrameKind::extended, 0, {}}));
  EXPECT_FALSE(is_roio({0x123, FrameKind::standard, 0, {}}));
  EXPECT_FALSE(is_roio({from_0_10_to_0_2, FrameKind::extended_remote, 0, {}}));
}

std::string times(TimeColumn::Mode mode, std::initializer_list<std::int64_t> nanoseconds) {
  TimeColumn column(mode);
  Buffer out;
  for (const std::int64_t time : nanoseconds) {
    column.append(out, Timestamp(std::chrono::nanoseconds(time)));
  }
  return {out.data(), out.size()};
}

constexpr std::int64_t start = 1436509052'249713'999;  // nanoseconds are cut off, as candump does

TEST(TimeColumn, NoneIsNothing) {
  EXPECT_EQ(times(TimeColumn::Mode::none, {start}), "");
}
TEST(TimeColumn, AbsoluteIsSecondsSince1970) {
  EXPECT_EQ(times(TimeColumn::Mode::absolute, {start, 1'000}),
            "(1436509052.249713) (0000000000.000001) ");
}
// As candump -t A, in the time zone of who looks.
TEST(TimeColumn, DateIsTheLocalOne) {
  const char* const zone = std::getenv("TZ");
  const std::string before = zone != nullptr ? zone : "";
  ::setenv("TZ", "XST-5:45", 1);  // east of Greenwich, by no whole hours
  ::tzset();
  EXPECT_EQ(times(TimeColumn::Mode::date, {start, start + 1'000'000, start + 1'000'000'000, 0, -1}),
            "(2015-07-10 12:02:32.249713) (2015-07-10 12:02:32.250713) "
            "(2015-07-10 12:02:33.249713) (1970-01-01 05:45:00.000000) "
            "(1970-01-01 05:44:59.999999) ");
  zone != nullptr ? ::setenv("TZ", before.c_str(), 1) : ::unsetenv("TZ");
  ::tzset();
}
TEST(TimeColumn, DeltaIsSinceTheFrameBefore) {
  EXPECT_EQ(times(TimeColumn::Mode::delta, {start, start + 1'500'000'000, start + 1'501'000'000}),
            "(000.000000) (001.500000) (000.001000) ");
}
TEST(TimeColumn, ZeroIsSinceTheFirst) {
  EXPECT_EQ(times(TimeColumn::Mode::zero, {start, start + 1'500'000'000, start + 1001'000'000'000}),
            "(000.000000) (001.500000) (1001.000000) ");
}
TEST(TimeColumn, AClockThatWentBackIsNoTimePassed) {
  EXPECT_EQ(times(TimeColumn::Mode::delta, {start, start - 1'000'000, start}),
            "(000.000000) (000.000000) (000.001000) ");
}

}  // namespace
}  // namespace roio::cli
