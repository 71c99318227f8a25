// The local bus's wire on its own, with time that moves only when a test says so.
#include "local/medium.hpp"

#include <gtest/gtest.h>

#include <roio/frame_length.hpp>
#include <roio/header.hpp>

namespace roio::local {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

constexpr Medium::TimePoint start{std::chrono::hours(1)};

Frame frame_to(std::uint8_t node, Priority priority = Priority::normal, std::uint8_t tag = 0) {
  return Frame{
      pack_id({priority, MessageClass::message, {0, node}, {0, 1}}), FrameKind::extended, 1, {tag}};
}

std::shared_ptr<Station> add_station(Medium& medium, std::uint64_t sender) {
  auto station = std::make_shared<Station>(sender, 0);
  medium.attach(station);
  return station;
}

void offer(Station& station, const Frame& frame, std::uint64_t sequence = 1) {
  station.add(lane_of(frame), {frame, sequence});
}

// The tags (first data byte) of all that passes by `now`.
std::vector<int> tags_passed(Medium& medium, Medium::TimePoint now) {
  std::vector<int> tags;
  while (const auto passed = medium.next(now)) {
    tags.push_back(passed->offer.frame.data[0]);
  }
  return tags;
}

TEST(Medium, NothingOfferedNothingPasses) {
  Medium medium(std::nullopt);
  add_station(medium, 1);
  medium.offered(start);
  EXPECT_FALSE(medium.next(start));
  EXPECT_FALSE(medium.contended());
  EXPECT_FALSE(medium.next_end());
}

TEST(Medium, LowestIdentifierOfAllStationsFirst) {
  Medium medium(std::nullopt);
  const auto a = add_station(medium, 1);
  const auto b = add_station(medium, 2);
  const auto c = add_station(medium, 3);
  offer(*a, frame_to(9, Priority::normal, 9));
  offer(*b, frame_to(2, Priority::normal, 2));
  offer(*c, frame_to(5, Priority::normal, 5));
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{2, 5, 9}));
}

TEST(Medium, OneStationKeepsItsOrderWhateverItsIdentifiers) {
  Medium medium(std::nullopt);
  const auto a = add_station(medium, 1);
  offer(*a, frame_to(9, Priority::normal, 1));
  offer(*a, frame_to(2, Priority::normal, 2));
  offer(*a, frame_to(5, Priority::normal, 3));
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{1, 2, 3}));
}

TEST(Medium, UrgentPassesTheStationsOwnNormalFramesInOrder) {
  Medium medium(std::nullopt);
  const auto a = add_station(medium, 1);
  offer(*a, frame_to(1, Priority::normal, 1));
  offer(*a, frame_to(9, Priority::urgent, 2));
  offer(*a, frame_to(8, Priority::urgent, 3));
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{2, 3, 1}));
}

TEST(Medium, StandardFrameWinsOverExtendedWithTheSameFirstBits) {
  Medium medium(std::nullopt);
  const auto a = add_station(medium, 1);
  const auto b = add_station(medium, 2);
  offer(*a, Frame{UINT32_C(0x123) << 18, FrameKind::extended, 1, {2}});
  offer(*b, Frame{0x123, FrameKind::standard, 1, {1}});
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{1, 2}));
}

TEST(Medium, StationsWithOneIdentifierTakeTurns) {
  Medium medium(std::nullopt);
  const auto a = add_station(medium, 1);
  const auto b = add_station(medium, 2);
  for (std::uint8_t i = 0; i < 3; ++i) {
    offer(*a, frame_to(2, Priority::normal, 10));
    offer(*b, frame_to(2, Priority::normal, 20));
  }
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{10, 20, 10, 20, 10, 20}));
}

TEST(Medium, FrameTakesItsExactBitsAtTheBitRate) {
  constexpr std::uint32_t bitrate_bps = 500'000;  // 2,000 ns a bit
  Medium medium(bitrate_bps);
  const auto a = add_station(medium, 1);
  // Worked out in docs/protocol.md: an identifier of zeros and no data is 74 bits with 7 stuff
  // bits.
  offer(*a, Frame{0, FrameKind::extended, 0, {}});
  medium.offered(start);
  EXPECT_FALSE(medium.next(start));
  ASSERT_TRUE(medium.next_end());
  EXPECT_EQ(*medium.next_end() - start, nanoseconds(74 * 2000));
  EXPECT_FALSE(medium.next(*medium.next_end() - nanoseconds(1)));
  const auto passed = medium.next(*medium.next_end());
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->end - start, nanoseconds(74 * 2000));
}

TEST(Medium, BackToBackFramesFollowWithoutAGapThoughTheCallerIsLate) {
  Medium medium(1'000'000);
  const auto a = add_station(medium, 1);
  const Frame frame = frame_to(2);
  for (std::uint64_t i = 1; i <= 3; ++i) {
    offer(*a, frame, i);
  }
  medium.offered(start);
  EXPECT_FALSE(medium.next(start));
  const auto late = start + std::chrono::milliseconds(5);
  const auto bits = microseconds(wire_bits(frame));
  for (int i = 1; i <= 3; ++i) {
    const auto passed = medium.next(late);
    ASSERT_TRUE(passed);
    EXPECT_EQ(passed->end - start, i * bits);
  }
  EXPECT_FALSE(medium.next(late));
}

TEST(Medium, AfterALongStopItGoesOnFromNow) {
  Medium medium(1'000'000);
  const auto a = add_station(medium, 1);
  const Frame frame = frame_to(2);
  constexpr std::uint64_t offered = 5000;  // more than half a second's
  for (std::uint64_t i = 1; i <= offered; ++i) {
    offer(*a, frame, i);
  }
  medium.offered(start);
  EXPECT_FALSE(medium.next(start));
  const auto late = start + std::chrono::seconds(5);
  const std::size_t at_once = tags_passed(medium, late).size();
  const auto longest = std::chrono::milliseconds(100) / microseconds(wire_bits(frame));
  EXPECT_EQ(at_once, static_cast<std::size_t>(longest) + 1) << "with the one that was on the wire";
  EXPECT_GT(*medium.next_end(), late);
}

TEST(Medium, IdleTimeIsNotSavedUp) {
  Medium medium(1'000'000);
  const auto a = add_station(medium, 1);
  offer(*a, frame_to(2));
  medium.offered(start);
  static_cast<void>(tags_passed(medium, start));
  static_cast<void>(tags_passed(medium, start + std::chrono::milliseconds(1)));
  const auto later = start + std::chrono::seconds(1);
  offer(*a, frame_to(2));
  medium.offered(later);
  EXPECT_FALSE(medium.next(later));
  EXPECT_EQ(*medium.next_end() - later, microseconds(wire_bits(frame_to(2))));
}

TEST(Medium, AFrameOnTheWireIsNotOvertaken) {
  Medium medium(1'000'000);
  const auto a = add_station(medium, 1);
  const auto b = add_station(medium, 2);
  offer(*a, frame_to(200, Priority::normal, 1));
  medium.offered(start);
  EXPECT_FALSE(medium.next(start));
  offer(*b, frame_to(200, Priority::normal, 2));
  offer(*b, frame_to(0, Priority::urgent, 3));
  medium.offered(start + microseconds(10));
  EXPECT_EQ(tags_passed(medium, start + std::chrono::milliseconds(1)), (std::vector<int>{1, 3, 2}));
}

TEST(Medium, AFrameIsOnTheWireFromWhenItCame) {
  Medium medium(1'000'000);
  const auto a = add_station(medium, 1);
  offer(*a, frame_to(2));
  medium.offered(start);
  medium.offered(start + microseconds(3));
  EXPECT_FALSE(medium.next(start + microseconds(3)));
  EXPECT_EQ(*medium.next_end() - start, microseconds(wire_bits(frame_to(2))));
}

TEST(Medium, FramesOfAStationThatLeftStillPass) {
  Medium medium(std::nullopt);
  const auto a = add_station(medium, 1);
  offer(*a, frame_to(2, Priority::normal, 1));
  offer(*a, frame_to(2, Priority::normal, 2));
  medium.detach(a);
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{1, 2}));
}

TEST(Medium, FramesThatAStationOffersAnewAreDropped) {
  Medium medium(std::nullopt);
  const auto before = add_station(medium, 1);
  const auto other = add_station(medium, 2);
  offer(*before, frame_to(2, Priority::normal, 1));
  offer(*other, frame_to(2, Priority::normal, 2));
  medium.detach(before);
  medium.detach(other);
  medium.drop_station_of(1);
  medium.offered(start);
  EXPECT_EQ(tags_passed(medium, start), (std::vector<int>{2}));
}

}  // namespace
}  // namespace roio::local
