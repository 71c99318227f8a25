// The small parts of a serial session: what it is to be told, its output, RESULTS that are overdue,
// and frames that arrive.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "serial/arrivals.hpp"
#include "serial/output.hpp"
#include "serial/results_watch.hpp"
#include "serial/set_up.hpp"

namespace roio::serial {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// --- set up --------------------------------------------------------------------------------------

KnownBridge bridge_at(std::uint32_t bitrate_bps, BridgeMode mode) {
  Welcome welcome{};
  welcome.info.bitrate_bps = bitrate_bps;
  welcome.info.mode = mode;
  KnownBridge bridge;
  bridge.begin(welcome);
  return bridge;
}

/// What a bridge at 500 kbit/s, normal, is told; it takes everything.
std::vector<Down> told(const SerialSettings& settings) {
  KnownBridge bridge = bridge_at(500'000, BridgeMode::normal);
  SetUp set_up;
  EXPECT_TRUE(set_up.takes_line_rate());
  EXPECT_FALSE(set_up.takes_line_rate()) << "once";
  std::vector<Down> operations;
  while (const auto request = set_up.next(settings, bridge)) {
    operations.push_back(request->operation);
    if (request->done) {
      request->done({Reply::Kind::answered, Status::ok});
    }
  }
  return operations;
}

TEST(SerialSetUp, TellsTheBridgeWhatItDoesNotHave) {
  EXPECT_EQ(told({}), std::vector<Down>{});
  EXPECT_EQ(told({.bitrate_bps = 500'000, .mode = BridgeMode::normal}), std::vector<Down>{});
  EXPECT_EQ(told({.bitrate_bps = 250'000}), std::vector{Down::bus});
  EXPECT_EQ(told({.mode = BridgeMode::listen}), std::vector{Down::bus});
  EXPECT_EQ(told({.address = Address{0, 7}}), std::vector{Down::address});
  EXPECT_EQ(told({.bitrate_bps = 250'000, .address = Address{0, 7}, .rules = std::vector<Rule>{}}),
            (std::vector{Down::bus, Down::address, Down::filter}));
}

TEST(SerialSetUp, KnowsWhatTheBridgeHasTaken) {
  KnownBridge bridge = bridge_at(500'000, BridgeMode::normal);
  const auto request = bus_request(bridge, 250'000, BridgeMode::loopback, {});
  request.done({Reply::Kind::answered, Status::bad_timing});
  EXPECT_EQ(bridge.info().bitrate_bps, 500'000U) << "refused";
  request.done({Reply::Kind::answered, Status::no_chip});
  EXPECT_EQ(bridge.info().bitrate_bps, 250'000U) << "kept until there is a controller";
  EXPECT_EQ(bridge.info().mode, BridgeMode::loopback);
}

// --- output --------------------------------------------------------------------------------------

TEST(SerialOutput, GivesItsBytesOnceAndSaysWhenThereAreTooMany) {
  Output output;
  output.put_hello(0x01020304);
  const std::vector hello(output.bytes().begin(), output.bytes().end());
  output.put_delimiter();
  EXPECT_EQ(output.bytes().size(), hello.size() + 1);
  output.consume(hello.size());
  EXPECT_EQ(output.bytes().size(), 1U);
  EXPECT_FALSE(output.is_clogged());
  while (output.bytes().size() < 1024) {
    EXPECT_FALSE(output.is_clogged());
    output.put_delimiter();
  }
  EXPECT_TRUE(output.is_clogged());
  output.clear();
  EXPECT_TRUE(output.bytes().empty());
}

TEST(SerialOutput, KnowsTheByteThatHarmsABootLoader) {
  EXPECT_TRUE(hello_is_harmful(0x11640000));
  EXPECT_TRUE(hello_is_harmful(0x64));
  const auto harmless = [](std::uint32_t session) {
    Output output;
    output.put_hello(session);
    return std::ranges::count(output.bytes(), 0x64) == 0;
  };
  unsigned found = 0;
  for (std::uint32_t session = 1; session < 2000; ++session) {
    ASSERT_EQ(hello_is_harmful(session), !harmless(session)) << session;
    found += hello_is_harmful(session) ? 1U : 0U;
  }
  EXPECT_GT(found, 0U);
  EXPECT_LT(found, 200U);
}

// --- RESULTS that are overdue --------------------------------------------------------------------

const Frame some_frame{0x1000400A, FrameKind::extended, 0, {}};

TEST(SerialResultsWatch, CountsFromWhenThereWasSomethingToTell) {
  DownFrames down;
  ResultsWatch watch;
  Time now = std::chrono::hours(1);
  watch.look(down, now);
  EXPECT_EQ(watch.deadline(down), Time::max()) << "nothing was sent";
  EXPECT_FALSE(watch.is_lost(down, now + seconds(10)));

  ASSERT_EQ(down.offer({&some_frame, 1}, Time::max()), 1U);
  ASSERT_TRUE(down.next());
  EXPECT_EQ(watch.deadline(down), now + milliseconds(100));
  EXPECT_FALSE(watch.is_stuck(down, now + milliseconds(99)));
  EXPECT_TRUE(watch.is_stuck(down, now + milliseconds(100)));
  EXPECT_FALSE(watch.is_lost(down, now + milliseconds(999)));
  EXPECT_TRUE(watch.is_lost(down, now + milliseconds(1000)));

  now += milliseconds(50);
  watch.came(DownFrames::Progress::none, now);
  EXPECT_TRUE(watch.is_stuck(down, now + milliseconds(50))) << "it told nothing new";
  EXPECT_FALSE(watch.is_lost(down, now + milliseconds(999))) << "but there is one that tells";
  watch.came(DownFrames::Progress::some, now);
  EXPECT_FALSE(watch.is_stuck(down, now + milliseconds(99)));
  watch.started_over(now + milliseconds(60));
  EXPECT_FALSE(watch.is_stuck(down, now + milliseconds(159)));
}

// --- frames that arrive --------------------------------------------------------------------------

std::vector<std::uint8_t> body_of(std::uint8_t sequence, std::uint16_t ticks) {
  return {0x10,
          0x00,
          0x40,
          0x0A,
          sequence,
          static_cast<std::uint8_t>(ticks >> 8),
          static_cast<std::uint8_t>(ticks)};
}

TEST(SerialArrivals, CountWhatIsMissingWithTheNext) {
  Arrivals arrivals;
  const Time now = std::chrono::hours(1);
  arrivals.begin();
  EXPECT_TRUE(arrivals.take(some_frame, body_of(0, 1), now));
  EXPECT_TRUE(arrivals.take(some_frame, body_of(3, 2), now));
  arrivals.expect(6);  // 4 and 5
  EXPECT_TRUE(arrivals.take(some_frame, body_of(6, 3), now));
  const auto all = arrivals.take_all();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].lost_before, 0U);
  EXPECT_EQ(all[1].lost_before, 2U);
  EXPECT_EQ(all[2].lost_before, 2U);
  EXPECT_EQ(arrivals.lost(), 4U);
  EXPECT_TRUE(arrivals.take_all().empty());
}

TEST(SerialArrivals, TellNoLossThatIsForgotten) {
  Arrivals arrivals;
  arrivals.begin();
  arrivals.expect(5);
  arrivals.forget_losses();
  EXPECT_TRUE(arrivals.take(some_frame, body_of(5, 1), seconds(1)));
  EXPECT_EQ(arrivals.take_all().at(0).lost_before, 0U);
  EXPECT_EQ(arrivals.lost(), 5U) << "but they count";
}

TEST(SerialArrivals, TakeARepeatedRecordOnce) {
  Arrivals arrivals;
  arrivals.begin();
  EXPECT_TRUE(arrivals.take(some_frame, body_of(0, 1), seconds(1)));
  EXPECT_FALSE(arrivals.take(some_frame, body_of(0, 1), seconds(1)));
  EXPECT_EQ(arrivals.take_all().size(), 1U);
  EXPECT_EQ(arrivals.lost(), 0U);
}

TEST(SerialArrivals, TwoImpossibleReportsInARowAreOfAnotherBoard) {
  using Told = Arrivals::Told;
  Arrivals arrivals;
  arrivals.begin();
  Time now = std::chrono::hours(1);
  EXPECT_EQ(arrivals.status(1000, 10, now), Told::sense);
  EXPECT_EQ(arrivals.lost(), 10U);
  EXPECT_EQ(arrivals.status(1000, 9, now), Told::nonsense) << "fewer frames than before";
  EXPECT_EQ(arrivals.status(1001, 10, now), Told::sense);
  EXPECT_EQ(arrivals.status(900, 10, now), Told::nonsense) << "time goes back";
  EXPECT_EQ(arrivals.status(901, 10, now), Told::other_board);
  arrivals.begin();
  EXPECT_EQ(arrivals.status(5, 0, now), Told::sense) << "a session of its own";
}

}  // namespace
}  // namespace roio::serial
