// A bus that is never idle, and every message on it for the board: it gets them all, in order, and
// has time left over.
#include <gtest/gtest.h>

#include <ostream>

#include "saturation.hpp"

namespace roio::load {
namespace {

using namespace std::chrono_literals;

struct Row {
  SaturationCase load;
  double left_over;  // of all the processor's time, at least
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.load.image << ", " << row.load.length << " bytes";
}

class SaturatedBus : public testing::TestWithParam<Row> {};

TEST_P(SaturatedBus, LosesNothingAndKeepsTheOrder) {
  const SaturationReport report = saturate(GetParam().load, 3s);
  EXPECT_GT(report.bus_load, 0.99);
  EXPECT_GT(report.sent, 1000U);
  EXPECT_EQ(report.overflowed, 0U);
  EXPECT_EQ(report.accepted, report.sent);
  EXPECT_EQ(report.received, report.sent);
  EXPECT_EQ(report.disordered, 0U);
  EXPECT_EQ(report.wrong, 0U);
  EXPECT_EQ(report.counted_received, report.sent % 65536);
  EXPECT_EQ(report.counted_overflows, 0U);
  EXPECT_EQ(report.chip_losses, 0U);
  EXPECT_EQ(report.line_losses, 0U) << "INT is connected, however the moments fall";
  EXPECT_GT(report.left_over, GetParam().left_over);
}

constexpr std::uint32_t mhz_16 = 16'000'000;
constexpr std::uint32_t mhz_8 = 8'000'000;
INSTANTIATE_TEST_SUITE_P(
    , SaturatedBus,
    testing::Values(Row{{"SaturatedPolled1000", 1'000'000, mhz_16, 0}, 0.16},
                    Row{{"SaturatedPolled1000", 1'000'000, mhz_16, 8}, 0.22},
                    Row{{"SaturatedInterrupt1000", 1'000'000, mhz_16, 0}, 0.31},
                    Row{{"SaturatedInterrupt1000", 1'000'000, mhz_16, 8}, 0.38},
                    Row{{"SaturatedPolled500At8", 500'000, mhz_8, 0}, 0.27}),
    [](const testing::TestParamInfo<Row>& row) {
      return std::string(row.param.load.image) + "With" + std::to_string(row.param.load.length) +
             "Bytes";
    });

// The measurement would show a loss: of a sketch that works for 250 us at a time.
TEST(SaturatedBusItself, ShowsWhatASlowSketchLoses) {
  const SaturationReport report =
      saturate({"SaturatedSlow", 1'000'000, mhz_16, 8}, std::chrono::seconds(1));
  EXPECT_GT(report.overflowed, 100U);
  EXPECT_GT(report.disordered, 100U);
  EXPECT_GT(report.counted_overflows, 100U);
  EXPECT_EQ(report.sent, report.accepted + report.overflowed);
  EXPECT_EQ(report.received, report.accepted);
  EXPECT_EQ(report.wrong, 0U);
}

}  // namespace
}  // namespace roio::load
