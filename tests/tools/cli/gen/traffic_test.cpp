// Traffic and Pace: which messages a generator sends, and when.
#include "gen/traffic.hpp"

#include <gtest/gtest.h>

#include <roio/message.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "gen/numbered.hpp"
#include "gen/pace.hpp"

namespace roio::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Message next(Traffic& traffic) {
  Message message{};
  EXPECT_EQ(to_message(traffic.next(), message), Status::ok);
  return message;
}

TrafficOptions fixed() {
  TrafficOptions options;
  options.id = 9;
  options.source = Address{0, 10};
  options.destination = Address{30, 254};
  return options;
}

TEST(Traffic, NumbersItsMessages) {
  Traffic traffic(fixed());
  for (std::uint32_t number = 0; number < 100; ++number) {
    const Message message = next(traffic);
    const auto numbered = read_numbered({message.data, message.length});
    ASSERT_TRUE(numbered);
    EXPECT_EQ(numbered->number, number);
    EXPECT_EQ(numbered->generator.id, 9);
    EXPECT_FALSE(numbered->generator.roams);
    EXPECT_EQ(message.length, 8);
    EXPECT_EQ(message.header.source, (Address{0, 10}));
    EXPECT_EQ(message.header.destination, (Address{30, 254}));
  }
}

TEST(Traffic, WhatIsRandomTakesEveryValueItMay) {
  TrafficOptions options = fixed();
  options.source.reset();
  options.destination.reset();
  options.shortest = 4;
  ASSERT_TRUE(options.is_random());
  Traffic traffic(options);
  std::set<int> lengths;
  std::set<int> subnets;
  std::set<int> nodes;
  for (int i = 0; i < 20000; ++i) {
    const Message message = next(traffic);
    ASSERT_TRUE(is_valid(message.header));
    EXPECT_TRUE(read_numbered({message.data, message.length})->generator.roams);
    lengths.insert(message.length);
    subnets.insert(message.header.source.subnet);
    nodes.insert(message.header.destination.node);
  }
  EXPECT_EQ(lengths, (std::set<int>{4, 5, 6, 7, 8}));
  EXPECT_EQ(subnets.size(), 32U);
  EXPECT_EQ(nodes.size(), 255U);
  EXPECT_EQ(nodes.count(broadcast_node), 0U) << "every node, and not all at once";
}

TEST(Traffic, OneSeedIsOneTraffic) {
  TrafficOptions options = fixed();
  options.destination.reset();
  const auto ids = [&](std::uint32_t seed) {
    options.seed = seed;
    Traffic traffic(options);
    std::vector<std::uint32_t> found;
    found.reserve(10);
    for (int i = 0; i < 10; ++i) {
      found.push_back(traffic.next().id);
    }
    return found;
  };
  EXPECT_EQ(ids(7), ids(7));
  EXPECT_NE(ids(7), ids(8));
}

TEST(Pace, SoManyGoInATime) {
  // units a second, units each, messages within a second
  for (const auto& [per_s, units, expected] : std::vector<std::tuple<double, double, int>>{
           {1, 1, 1}, {1000, 1, 1000}, {30000, 1, 30000}, {400000, 131, 3054}}) {
    const Pace::Clock::time_point start{};
    Pace pace(per_s, start);
    int count = 0;
    for (; pace.next() < start + seconds(1); ++count) {
      pace.spend(units, pace.next());
    }
    EXPECT_EQ(count, expected);
  }
}

TEST(Pace, ALittleDelayIsMadeUpForAndALongOneIsNot) {
  const Pace::Clock::time_point start{};
  Pace pace(1000, start);
  pace.spend(1, start + milliseconds(50));
  EXPECT_EQ(pace.next(), start + milliseconds(1)) << "49 may follow at once";
  pace.spend(1, start + seconds(10));
  EXPECT_EQ(pace.next(), start + seconds(10) - Pace::most_behind);
}

}  // namespace
}  // namespace roio::cli
