// TrafficTable: which frames make a row, and what a row says.
#include "top/traffic_table.hpp"

#include <gtest/gtest.h>

#include <roio/frame_length.hpp>
#include <roio/text.hpp>
#include <string>
#include <vector>

namespace roio::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Timestamp start{seconds(1'700'000'000)};

Frame message(Address source, Address destination, const char* data,
              Priority priority = Priority::normal,
              MessageClass message_class = MessageClass::message) {
  Message message{{priority, message_class, destination, source}, 0, {}};
  const Bytes bytes = *parse_hex(data);
  message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), message.data);
  Frame frame{};
  EXPECT_EQ(to_frame(message, frame), Status::ok);
  return frame;
}

class TrafficTableTest : public testing::Test {
 protected:
  void add(const Frame& frame, Timeout after) { table_.add({frame, start + after, 0}); }
  TrafficRow only_row() {
    EXPECT_EQ(table_.rows().size(), 1U);
    return table_.rows().at(0);
  }

  TrafficTable table_{numeric_labels()};
};

TEST_F(TrafficTableTest, WhatMakesARow) {
  const Frame first = message({0, 10}, {0, 2}, "5A2D00");
  Frame remote = first;
  remote.kind = FrameKind::extended_remote;
  Frame standard{0x123, FrameKind::standard, 3, {1, 2, 3}};
  Frame error{0x40, FrameKind::error, 8, {}};
  const std::vector<std::tuple<const char*, Frame, bool>> rows{
      {"other bytes", message({0, 10}, {0, 2}, "FFFFFF"), false},
      {"another length", message({0, 10}, {0, 2}, "5A2D"), true},
      {"no bytes", message({0, 10}, {0, 2}, ""), true},
      {"another source", message({0, 11}, {0, 2}, "5A2D00"), true},
      {"another source's subnet", message({1, 10}, {0, 2}, "5A2D00"), true},
      {"another destination", message({0, 10}, {0, 3}, "5A2D00"), true},
      {"a broadcast", message({0, 10}, {0, 255}, "5A2D00"), true},
      {"urgent", message({0, 10}, {0, 2}, "5A2D00", Priority::urgent), true},
      {"another class", message({0, 10}, {0, 2}, "5A2D00", Priority::normal, MessageClass::system),
       true},
      {"a remote request", remote, true},
      {"an 11-bit identifier", standard, true},
      {"an error report is no traffic", error, false},
  };
  for (const auto& [what, frame, is_new] : rows) {
    table_.clear();
    add(first, {});
    add(frame, milliseconds(1));
    EXPECT_EQ(table_.rows().size(), is_new ? 2U : 1U) << what;
  }
}

/// Tells messages apart by their first byte.
class TaggedLabels final : public Labels {
 public:
  [[nodiscard]] std::string address(Address /*address*/) const override { return "a"; }
  [[nodiscard]] MessageLabel message(const Message& /*message*/) const override { return {}; }
  [[nodiscard]] std::uint32_t variant(const Frame& frame) const noexcept override {
    return frame.data[0];
  }
  [[nodiscard]] std::size_t address_width() const noexcept override { return 1; }
  [[nodiscard]] std::size_t message_width() const noexcept override { return 1; }
};

TEST(TrafficTable, WhatLabelsTellApartHasRowsOfItsOwn) {
  const TaggedLabels labels;
  TrafficTable table(labels);
  for (const char* data : {"0102", "0202", "0103"}) {
    table.add({message({0, 10}, {0, 2}, data), start, 0});
  }
  EXPECT_EQ(table.rows().size(), 2U);
}

TEST_F(TrafficTableTest, MarksTheBytesThatChangedInTheLastIntervalThatBroughtAny) {
  const auto send = [&](const char* data) { add(message({0, 1}, {0, 2}, data), {}); };
  send("0102030405060708");
  table_.tick(start);
  EXPECT_EQ(only_row().changed, 0) << "the first one changes nothing";
  send("0102FF0405060708");
  table_.tick(start);
  EXPECT_EQ(only_row().changed, 1U << 2);
  table_.tick(start);
  EXPECT_EQ(only_row().changed, 1U << 2) << "nothing came since: it stays";
  send("0102FF0405060709");
  send("0102FF0405060708");
  send("FF02FF0405060708");
  table_.tick(start);
  EXPECT_EQ(only_row().changed, (1U << 7) | 1U) << "and back again within the interval";
  send("FF02FF0405060708");
  table_.tick(start);
  EXPECT_EQ(only_row().changed, 0);
}

TEST_F(TrafficTableTest, RatesOfPeriodicMessages) {
  // period, for how long, the rate, whether silent; asked at the last frame
  const std::vector<std::tuple<const char*, Timeout, int, double>> rows{
      {"1 kHz", milliseconds(1), 5000, 1000}, {"10 Hz", milliseconds(100), 50, 10},
      {"every 5 s", seconds(5), 4, 0.2},      {"every minute", seconds(60), 3, 1.0 / 60},
      {"two alone", milliseconds(500), 2, 2},
  };
  for (const auto& [what, period, count, rate] : rows) {
    table_.clear();
    Timeout next_tick{0};
    for (int i = 0; i < count; ++i) {
      for (; next_tick < period * i; next_tick += milliseconds(250)) {
        table_.tick(start + next_tick);
      }
      add(message({0, 1}, {0, 2}, "01"), period * i);
    }
    table_.tick(start + period * (count - 1));
    EXPECT_NEAR(only_row().rate, rate, rate * 0.001) << what;
    EXPECT_FALSE(only_row().silent) << what;
  }
}

TEST_F(TrafficTableTest, SilentIsWhatMissesThreePeriodsAndTwoSeconds) {
  const std::vector<std::tuple<const char*, Timeout, Timeout, bool>> rows{
      {"10 Hz: 2 s are not yet silence", milliseconds(100), seconds(2), false},
      {"10 Hz: more are", milliseconds(100), milliseconds(2001), true},
      {"1 Hz: 3 periods are not", seconds(1), milliseconds(2999), false},
      {"1 Hz: more are", seconds(1), milliseconds(3001), true},
      {"every minute", seconds(60), seconds(170), false},
  };
  for (const auto& [what, period, age, silent] : rows) {
    table_.clear();
    for (int i = 0; i <= 10; ++i) {
      add(message({0, 1}, {0, 2}, "01"), period * i);
      table_.tick(start + period * i);
    }
    table_.tick(start + period * 10 + age);
    EXPECT_EQ(only_row().silent, silent) << what;
    EXPECT_EQ(only_row().rate == 0, silent) << what;
    EXPECT_EQ(only_row().age, age) << what;
  }
}

TEST_F(TrafficTableTest, WhatComesBackHasItsOwnRateAtOnce) {
  for (int i = 0; i <= 20; ++i) {
    add(message({0, 1}, {0, 2}, "01"), milliseconds(100) * i);
    table_.tick(start + milliseconds(100) * i);
  }
  table_.tick(start + seconds(60));
  ASSERT_TRUE(only_row().silent);
  for (int i = 0; i <= 5; ++i) {
    add(message({0, 1}, {0, 2}, "01"), seconds(60) + milliseconds(50) * i);
  }
  table_.tick(start + seconds(60) + milliseconds(250));
  EXPECT_FALSE(only_row().silent);
  EXPECT_NEAR(only_row().rate, 20, 0.01);
}

TEST_F(TrafficTableTest, AClockThatIsSetBackMakesNoNegativeAgeOrRate) {
  for (int i = 0; i <= 20; ++i) {
    add(message({0, 1}, {0, 2}, "01"), milliseconds(100) * i);
  }
  table_.tick(start + seconds(2));
  table_.tick(start - seconds(100));
  EXPECT_EQ(only_row().age, no_wait);
  for (int i = 0; i <= 20; ++i) {
    add(message({0, 1}, {0, 2}, "01"), -seconds(100) + milliseconds(50) * i);
    table_.tick(start - seconds(100) + milliseconds(50) * i);
  }
  EXPECT_NEAR(only_row().rate, 20, 0.01);
}

TEST_F(TrafficTableTest, CountsFramesAndTheirBitsExactly) {
  std::uint64_t bits = 0;
  for (std::uint8_t i = 0; i < 200; ++i) {
    Frame frame = message({0, 1}, {0, 2}, "0000000000000000");
    frame.data[0] = i;
    bits += wire_bits(frame);
    add(frame, milliseconds(i));
  }
  EXPECT_EQ(only_row().frames, 200U);
  EXPECT_EQ(only_row().bits, bits);
  EXPECT_EQ(table_.frames(), 200U);
}

TEST_F(TrafficTableTest, RowsAreBoundedAndWhatHasNoneIsCounted) {
  for (std::uint32_t id = 0; id < TrafficTable::max_rows + 10; ++id) {
    add({id, FrameKind::extended, 0, {}}, {});
  }
  EXPECT_EQ(table_.rows().size(), TrafficTable::max_rows);
  EXPECT_EQ(table_.rowless(), 10U);
  EXPECT_EQ(table_.frames(), TrafficTable::max_rows + 10);
  add({0, FrameKind::extended, 0, {}}, {});
  EXPECT_EQ(table_.rowless(), 10U) << "those that have a row keep it";
  table_.clear();
  EXPECT_EQ(table_.rows().size() + table_.rowless() + table_.frames(), 0U);
}

TEST_F(TrafficTableTest, ALengthThatNoFrameHasCountsAsEight) {
  add({1, FrameKind::extended, 15, {}}, {});
  EXPECT_EQ(only_row().last.length, 8);
}

}  // namespace
}  // namespace roio::cli
