// What a UART hears at the wrong rate, by its bits.
#include "board/uart_sampling.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace roio::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes every_byte() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

TEST(UartSampling, RatesMatchWithinAFewPercent) {
  EXPECT_TRUE(sim::rates_match(115'200, 16e6 / 8 / 17));  // 2.1 %: what an Uno makes of 115,200
  EXPECT_TRUE(sim::rates_match(1'044'000, 1e6));
  EXPECT_FALSE(sim::rates_match(1'046'000, 1e6));
  EXPECT_TRUE(sim::rates_match(956'000, 1e6));
  EXPECT_FALSE(sim::rates_match(954'000, 1e6));
  EXPECT_FALSE(sim::rates_match(921'600, 1e6));
}

TEST(UartSampling, EveryByteIsRightAsLongAsRatesMatch) {
  for (const double ratio : {0.956, 1.0, 1.044}) {
    EXPECT_EQ(sim::sampled(every_byte(), ratio, 1), every_byte()) << ratio;
  }
}

// The last data bit is the first that is looked at too late, or too early.
TEST(UartSampling, TheLastBitGoesFirst) {
  Bytes too_late = every_byte();
  Bytes too_early = every_byte();
  for (int byte = 0; byte < 256; ++byte) {
    too_late[static_cast<std::size_t>(byte)] = static_cast<std::uint8_t>(byte | 0x80);
    too_early[static_cast<std::size_t>(byte)] =
        static_cast<std::uint8_t>((byte & 0x7F) | (byte & 0x40) << 1);
  }
  EXPECT_EQ(sim::sampled(every_byte(), 1.046, 1), too_late);
  EXPECT_EQ(sim::sampled(every_byte(), 0.954, 1), too_early);
}

TEST(UartSampling, FarOff) {
  struct Row {
    const char* why;
    double sender_bps;
    Bytes sent;
    Bytes heard;
  };
  const Row rows[] = {
      {"a start bit that is gone when it is looked at", 1e6, {0xFF}, {}},
      {"low for long enough, and then the idle line", 1e6, {0x00}, {0xFF}},
      {"several bytes within one", 1e6, {0x00, 0x00, 0xFF, 0xFF}, {0xFE}},
      {"a start bit as long as a byte", 13'271, {0xFF}, {0x00}},
      {"each falling edge begins a byte", 13'271, {0x55}, {0x00, 0x00, 0x00, 0x00, 0x00}},
      {"each bit twice, the start bit's second half first", 57'600, {0x03}, {0x1E}},
      {"nothing", 57'600, {}, {}},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(sim::sampled(row.sent, row.sender_bps, 115'200), row.heard) << row.why;
  }
}

}  // namespace
}  // namespace roio::test
