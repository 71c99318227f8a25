// HubWatch: which absences of a local bus are outages.
#include "listen/hub_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <tuple>
#include <utility>
#include <vector>

namespace roio::cli {
namespace {

using std::chrono::milliseconds;

TEST(HubWatch, WhichAbsencesAreOutages) {
  using Looks = std::vector<std::pair<milliseconds, BusState>>;
  constexpr BusState there = BusState::active;
  constexpr BusState gone = BusState::absent;
  const std::vector<std::tuple<const char*, Looks, std::uint64_t>> rows{
      {"never gone", {{milliseconds(0), there}, {milliseconds(9000), there}}, 0},
      {"the hub changes", {{milliseconds(0), gone}, {milliseconds(300), there}}, 0},
      {"a moment less than an outage", {{milliseconds(0), gone}, {milliseconds(1999), there}}, 0},
      {"an outage that is over", {{milliseconds(0), gone}, {milliseconds(2000), there}}, 1},
      {"one that lasts", {{milliseconds(0), gone}, {milliseconds(2000), gone}}, 1},
      {"it counts once",
       {{milliseconds(0), gone},
        {milliseconds(2000), gone},
        {milliseconds(9000), gone},
        {milliseconds(9500), there}},
       1},
      {"hubs that change again and again",
       {{milliseconds(0), gone},
        {milliseconds(1500), there},
        {milliseconds(1600), gone},
        {milliseconds(3100), there}},
       0},
      {"two",
       {{milliseconds(0), gone},
        {milliseconds(2500), there},
        {milliseconds(3000), gone},
        {milliseconds(6000), there}},
       2},
      {"one that stands still is there",
       {{milliseconds(0), BusState::down}, {milliseconds(9000), there}},
       0},
  };
  for (const auto& [what, looks, expected] : rows) {
    HubWatch watch;
    for (const auto& [time, state] : looks) {
      watch.look(state, HubWatch::Clock::time_point(time));
    }
    EXPECT_EQ(watch.outages(), expected) << what;
  }
}

}  // namespace
}  // namespace roio::cli
