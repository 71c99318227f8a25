// The screen of `roio-cli top`, drawn from what is known, in every size.
#include "top/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "top/line.hpp"
#include "top/row_text.hpp"

namespace roio::cli {
namespace {

using Text = std::vector<std::string>;

TrafficRow row(std::uint32_t id, FrameKind kind, std::vector<std::uint8_t> data, double rate,
               Timeout age) {
  TrafficRow row;
  row.last = {id, kind, static_cast<std::uint8_t>(data.size()), {}};
  std::copy(data.begin(), data.end(), row.last.data);
  row.frames = 10;
  row.rate = rate;
  row.age = age;
  row.silent = rate == 0;
  return row;
}

Snapshot example() {
  Snapshot snapshot;
  snapshot.bus = "local:robot";
  snapshot.bitrate_bps = 500000;
  snapshot.load = {3120.4, 210500.0, 486500.0, 0.421, 0.973};
  snapshot.frames = 123456;
  snapshot.rows = {
      row(0x1000400A, FrameKind::extended, {0x5A, 0x2D, 0x00}, 10, std::chrono::milliseconds(120)),
      row(0x001FE003, FrameKind::extended, {1}, 0, std::chrono::seconds(75)),
      row(0x123, FrameKind::standard, {1, 2, 3, 4, 5, 6, 7, 8}, 812.3, Timeout(0)),
      row(0x1C00400A, FrameKind::extended_remote, {0, 0}, 0.05, std::chrono::seconds(9)),
  };
  snapshot.rows[0].changed = 2;
  snapshot.rows[2].changed = 0x80;
  return snapshot;
}

/// As it looks: without what spaces there are at the ends of lines.
Text drawn(const Snapshot& snapshot, const View& view, Size size) {
  Text lines = draw(snapshot, view, numeric_labels(), size, false);
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

TEST(View, In80By24EverythingIsThere) {
  const Text expected{
      "local:robot  error-active  500000 bit/s",
      "load  42.1 %, peak  97.3 %, 3120 frames/s, 210500 bit/s",
      "123456 frames, 0 lost, 0 errors, 0 times bus-off, 0 outages",
      "source      to        class    msg  rate/s     age  value",
      "0.3      -> 0.*       message  [1]       -    75 s  01",
      "0.10     -> 0.2       message  [3]    10.0   0.1 s  5A 2D*00",
      "11-bit      123       foreign  [8]     812   0.0 s  01 02 03 04 05 06 07 08*",
      "29-bit      1C00400A  foreign  [2]    0.05   9.0 s  remote request",
  };
  Text lines = drawn(example(), {}, {80, 24});
  ASSERT_EQ(lines.size(), 24U);
  EXPECT_EQ(lines.back(), "q quit  s sort: source  r reverse  p pause  c clear  h help");
  lines.resize(expected.size());
  EXPECT_EQ(lines, expected);
}

TEST(View, In40By10TheValueIsCutOffAndSaysSo) {
  EXPECT_EQ(drawn(example(), {}, {40, 10}), (Text{
                                                "local:robot  error-active  500000 bit/s",
                                                "load  42.1 %, peak  97.3 %, 3120 frames/",
                                                "123456 frames, 0 lost, 0 errors, 0 times",
                                                "source   dest     msg rate/s value",
                                                "0.3      0.*      [1]      - 01",
                                                "0.10     0.2      [3]   10.0 5A 2D*00",
                                                "11-bit   123      [8]    812 01 02 03 +",
                                                "29-bit   1C00400A [2]   0.05 remote req+",
                                                "",
                                                "q quit  h help  s sort: source",
                                            }));
}

TEST(View, AWideScreenHasPriorityAndCounts) {
  const Text lines = drawn(example(), {}, {120, 24});
  EXPECT_EQ(lines[3],
            "source      to        prio    class    msg     frames  rate/s     age  value");
  EXPECT_EQ(lines[4], "0.3      -> 0.*       urgent  message  [1]         10       -    75 s  01");
}

TEST(View, NoSizeIsTooSmallAndNoLineTooWide) {
  const Snapshot snapshot = example();
  for (std::size_t columns = 1; columns < 130; ++columns) {
    for (std::size_t lines = 1; lines < 30; ++lines) {
      for (const bool help : {false, true}) {
        View view;
        view.help = help;
        const Text text = draw(snapshot, view, numeric_labels(), {columns, lines}, false);
        ASSERT_EQ(text.size(), lines) << columns << "x" << lines;
        for (const std::string& line : text) {
          ASSERT_LE(width_of(line), columns) << columns << "x" << lines << ": " << line;
        }
      }
    }
  }
}

TEST(View, ColoursAddNothingToTheWidth) {
  const auto without_colours = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('\033')) != std::string::npos;) {
      text.erase(at, text.find('m', at) - at + 1);
    }
    return text;
  };
  for (const std::size_t columns : {80U, 40U, 13U}) {
    const Text plain = draw(example(), {}, numeric_labels(), {columns, 10}, false);
    const Text coloured = draw(example(), {}, numeric_labels(), {columns, 10}, true);
    EXPECT_NE(plain, coloured);
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_EQ(without_colours(coloured[i]), plain[i]);
    }
  }
}

TEST(View, WhatIsWrongIsSaidOnTop) {
  Snapshot snapshot = example();
  snapshot.state = BusState::absent;
  snapshot.bitrate_bps.reset();
  snapshot.load.share.reset();
  snapshot.lost = 7;
  snapshot.errors = 1;
  snapshot.bus_offs = 2;
  snapshot.outages = 1;
  snapshot.overruns = 1;
  snapshot.fd_frames = 3;
  snapshot.rowless = 12;
  View view;
  view.paused = true;
  Text lines = drawn(snapshot, view, {160, 24});
  lines.resize(3);
  EXPECT_EQ(lines,
            (Text{
                "local:robot  absent  PAUSED",
                "3120 frames/s, 210500 bit/s, peak 486500 bit/s; load: see --bitrate",
                "123456 frames, 7 lost, 12 without a row, the controller lost some 1 time, 1 "
                "error, 2 times bus-off, 1 outage, 3 CAN FD frames not shown",
            }));
}

TEST(View, AnEmptyBusSaysSo) {
  EXPECT_EQ(drawn({}, {}, {80, 24})[4], "nothing heard yet");
}

Snapshot many(std::size_t rows) {
  Snapshot snapshot;
  for (std::size_t i = 0; i < rows; ++i) {
    snapshot.rows.push_back(row(static_cast<std::uint32_t>(i), FrameKind::standard, {}, 1, {}));
  }
  return snapshot;
}

TEST(View, ScrollsAsFarAsThereAreRows) {
  const Size size{80, 24};
  ASSERT_EQ(rows_on_screen(size), 19U);
  // what is pressed, the first row after it
  const std::vector<std::tuple<Action, std::size_t>> steps{
      {Action::line_up, 0},    {Action::line_down, 1},  {Action::page_down, 20},
      {Action::page_down, 26}, {Action::line_down, 26}, {Action::page_up, 7},
      {Action::line_up, 6},    {Action::to_last, 26},   {Action::to_first, 0},
  };
  View view;
  for (const auto& [action, first] : steps) {
    view = after(view, action, 45, size);
    EXPECT_EQ(view.first_row, first);
  }
  view = after(view, Action::to_last, 45, size);
  const Text lines = drawn(many(45), view, size);
  EXPECT_EQ(lines[4].substr(0, 16), "11-bit    01A   ");
  EXPECT_EQ(lines[23],
            "q quit  s sort: source  r reverse  p pause  c clear  h help     rows 27-45 of 45");
}

TEST(View, RowsThatWentLeaveNoEmptyScreen) {
  View view;
  view.first_row = 1000;
  EXPECT_EQ(drawn(many(20), view, {80, 24})[4].substr(0, 16), "11-bit    001   ");
  EXPECT_EQ(after(view, Action::line_up, 20, {80, 24}).first_row, 0U);
  EXPECT_EQ(after(view, Action::line_up, 0, {80, 24}).first_row, 0U);
}

TEST(View, EverySortKeyAndItsReverse) {
  Snapshot snapshot;
  // source 0.1 to 0.9, 0.2 to 0.8, 0.3 to 0.7
  snapshot.rows = {
      row(0x10010003 | 7U << 13, FrameKind::extended, {}, 30, std::chrono::seconds(3)),
      row(0x10000001 | 9U << 13, FrameKind::extended, {}, 20, std::chrono::seconds(1)),
      row(0x10000002 | 8U << 13, FrameKind::extended, {}, 10, std::chrono::seconds(2))};
  snapshot.rows[0].last.id = 0x10000003U | 7U << 13;
  snapshot.rows[1].frames = 5;
  const auto sources = [&](const View& view) {
    std::string text;
    for (const TrafficRow& one : sorted(snapshot.rows, view)) {
      text += std::to_string(one.last.id & 0xFFU);
    }
    return text;
  };
  View view;
  for (const char* order : {"123", "321", "312", "123", "231"}) {
    View reversed = after(view, Action::reverse, 3, {});
    std::string backwards = order;
    if (view.sort != SortKey::frames) {  // two are equal there
      std::reverse(backwards.begin(), backwards.end());
      EXPECT_EQ(sources(reversed), backwards);
    }
    EXPECT_EQ(sources(view), order) << static_cast<int>(view.sort);
    view = after(view, Action::sort, 3, {});
  }
  EXPECT_EQ(view.sort, SortKey::source) << "and round again";
}

/// As a robot file has them.
class NamedLabels final : public Labels {
 public:
  [[nodiscard]] std::string address(Address address) const override {
    return address.node == 2 ? "arm" : "a very long name indeed";
  }
  [[nodiscard]] MessageLabel message(const Message& /*message*/) const override {
    return {"angles", "shoulder=90° elbow=45° hand=0°\n", true};
  }
  [[nodiscard]] std::uint32_t variant(const Frame& /*frame*/) const noexcept override { return 0; }
  [[nodiscard]] std::size_t address_width() const noexcept override { return 1; }
  [[nodiscard]] std::size_t message_width() const noexcept override { return 1; }
};

TEST(View, NamesHaveTheRoomTheyNeedAndFieldsTheRest) {
  Snapshot snapshot = example();
  snapshot.rows.resize(1);
  const Text lines = draw(snapshot, {}, NamedLabels(), {80, 24}, false);
  EXPECT_EQ(lines[4],
            "a very long nam+ -> arm               angles    10.0  shoulder=90° elbow=45° ha+");
}

TEST(RowText, RatesAndAges) {
  for (const auto& [rate, text] : std::vector<std::pair<double, const char*>>{{0, "-"},
                                                                              {0.004, "0.00"},
                                                                              {0.05, "0.05"},
                                                                              {9.994, "9.99"},
                                                                              {9.996, "10.0"},
                                                                              {99.94, "99.9"},
                                                                              {99.96, "100"},
                                                                              {15000.4, "15000"}}) {
    EXPECT_EQ(rate_text(rate), text);
  }
  for (const auto& [age, text] :
       std::vector<std::pair<Timeout, const char*>>{{std::chrono::milliseconds(0), "0.0 s"},
                                                    {std::chrono::milliseconds(9949), "9.9 s"},
                                                    {std::chrono::milliseconds(9951), "10 s"},
                                                    {std::chrono::seconds(99), "99 s"},
                                                    {std::chrono::seconds(120), "2 min"},
                                                    {std::chrono::hours(3), "3 h"},
                                                    {std::chrono::hours(24 * 30), "30 d"}}) {
    EXPECT_EQ(age_text(age), text);
  }
}

TEST(Line, CutsAndFillsByWhatIsSeen) {
  Line line(10, false);
  line.add_left("90°", 5);
  line.add("|");
  line.add_right("90°", 4);
  EXPECT_EQ(line.text(), "90°  | 90°");
  line.add("more");
  EXPECT_EQ(line.text(), "90°  | 90°");
  Line cut(80, false);
  cut.add_left("°°°°", 3);
  cut.add_left("ab\033c", 4);
  cut.add_left("x", 0);
  EXPECT_EQ(cut.text(), "°°+ab?c");
}

}  // namespace
}  // namespace roio::cli
