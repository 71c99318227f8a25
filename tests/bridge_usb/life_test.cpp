// A frame from the PC is on the bus within its life, or never.
#include "bridge_rig.hpp"

namespace roio::test {
namespace {

constexpr std::uint8_t life_of_half_a_second = 0x5F;  // 492 ms
constexpr std::uint32_t urgent_id = 0x0000400A;
constexpr std::uint32_t normal_id = 0x1000400A;
constexpr int not_sent_counter = 3;

/// Slot n of the last RESULTS.
std::optional<serial::Outcome> outcome(const BridgeRig& rig, std::uint8_t slot) {
  const auto results = rig.last(serial::Up::results);
  return results ? std::optional(static_cast<serial::Outcome>(
                       serial::get32(results->data() + 4) >> (2 * slot) & 3U))
                 : std::nullopt;
}

/// What the peer has heard a while after it has come back.
std::vector<Frame> heard_when_the_peer_comes_back(BridgeRig& rig) {
  rig.on_bus.clear();
  rig.set_peer(true);
  rig.bus.run_for(2s);
  return rig.on_bus;
}

class Life : public testing::TestWithParam<sim::BoardKind> {};
INSTANTIATE_TEST_SUITE_P(Board, Life,
                         testing::Values(sim::BoardKind::uno, sim::BoardKind::leonardo),
                         [](const auto& kind) { return std::string(sim::to_string(kind.param)); });

TEST_P(Life, WhatNobodyAcknowledgesIsTakenBackInTimeAndNeverComesLater) {
  BridgeRig rig(GetParam());
  rig.hello();
  rig.set_peer(false);
  for (std::uint8_t i = 0; i < 5; ++i) {
    rig.send(extended(normal_id, {i}), life_of_half_a_second);
  }
  rig.poll_for(450ms);
  for (std::uint8_t i = 0; i < 5; ++i) {
    EXPECT_EQ(outcome(rig, i), serial::Outcome::pending) << "not before its time";
  }
  rig.poll_for(100ms);
  for (std::uint8_t i = 0; i < 5; ++i) {
    EXPECT_EQ(outcome(rig, i), serial::Outcome::not_sent);
  }
  EXPECT_TRUE(heard_when_the_peer_comes_back(rig).empty());
  rig.hello(2);
  EXPECT_EQ(rig.counter(not_sent_counter), 5U);
}

TEST(LifeOfAFrame, WhoComesInTimeHasIt) {
  BridgeRig rig;
  rig.hello();
  rig.set_peer(false);
  rig.send(extended(normal_id, {1}), life_of_half_a_second);
  rig.poll_for(400ms);
  rig.set_peer(true);
  rig.poll_for(50ms);
  EXPECT_EQ(rig.on_bus.size(), 1U);
  EXPECT_EQ(outcome(rig, 0), serial::Outcome::sent);
}

TEST(LifeOfAFrame, TheLongestIs31SecondsOrForEver) {
  BridgeRig rig;
  rig.hello();
  ASSERT_EQ(rig.request(serial::Down::bus, bytes_of(10'000) + Bytes{0}), Status::ok);  // few tries
  rig.set_peer(false);
  rig.send(extended(normal_id, {1}), serial::longest_life);
  rig.send(extended(normal_id, {2}), serial::longest_life + 1);  // not used: as the longest
  rig.send(extended(normal_id, {3}), serial::life_forever);
  rig.poll_for(31'400ms);
  for (std::uint8_t i = 0; i < 3; ++i) {
    EXPECT_EQ(outcome(rig, i), serial::Outcome::pending);
  }
  rig.poll_for(150ms);
  EXPECT_EQ(outcome(rig, 0), serial::Outcome::not_sent);
  EXPECT_EQ(outcome(rig, 1), serial::Outcome::not_sent);
  rig.poll_for(5s);
  EXPECT_EQ(outcome(rig, 2), serial::Outcome::pending);
}

TEST(LifeOfAFrame, OneThatIsOverAlreadyUsesItsNumberUp) {
  BridgeRig rig;
  rig.hello();
  rig.send(extended(normal_id, {1}), 0);
  rig.send(extended(normal_id, {2}));
  rig.poll_for(50ms);
  EXPECT_EQ(outcome(rig, 0), serial::Outcome::not_sent);
  EXPECT_EQ(outcome(rig, 1), serial::Outcome::sent);
  EXPECT_EQ(rig.on_bus.size(), 1U);
  EXPECT_EQ(rig.counter(not_sent_counter), 1U);
}

// The chip is told to let go of all that it has: what is not over goes out all the same, in order.
TEST(LifeOfAFrame, OthersStay) {
  BridgeRig rig;
  rig.hello();
  rig.set_peer(false);
  for (std::uint8_t i = 0; i < 12; ++i) {
    const bool short_lived = i == 0 || i == 5;
    rig.send(extended(i == 7 ? urgent_id : normal_id, {i}),
             short_lived ? life_of_half_a_second : serial::life_forever);
  }
  rig.poll_for(700ms);
  const std::vector<Frame> heard = heard_when_the_peer_comes_back(rig);
  std::vector<int> numbers;
  for (const Frame& frame : heard) {
    numbers.push_back(frame.data[0]);
  }
  EXPECT_EQ(numbers, (std::vector<int>{7, 1, 2, 3, 4, 6, 8, 9, 10, 11}));
}

TEST(LifeOfAFrame, ABridgeThatOnlyListensSaysSoAndCounts) {
  BridgeRig rig;
  rig.hello();
  ASSERT_EQ(rig.request(serial::Down::bus, bytes_of(500'000) + Bytes{1}), Status::ok);
  for (std::uint8_t i = 0; i < 3; ++i) {
    rig.send(extended(normal_id, {i}));
  }
  rig.poll_for(50ms);
  EXPECT_EQ(outcome(rig, 2), serial::Outcome::not_sent);
  EXPECT_EQ(rig.counter(not_sent_counter), 3U);
}

// --- whatever ends a session
// ----------------------------------------------------------------------

struct Ending {
  const char* name;
  void (*end)(BridgeRig& rig);
};
void PrintTo(const Ending& ending, std::ostream* out) {
  *out << ending.name;
}

class EndOfASession : public testing::TestWithParam<Ending> {};
INSTANTIATE_TEST_SUITE_P(
    By, EndOfASession,
    testing::Values(
        Ending{"bye",
               [](BridgeRig& rig) { EXPECT_EQ(rig.request(serial::Down::bye), Status::ok); }},
        Ending{"a_new_session", [](BridgeRig& rig) { rig.hello(2); }},
        Ending{"silence", [](BridgeRig& rig) { rig.bus.run_for(800ms); }},
        Ending{
            "another_rate",
            [](BridgeRig& rig) {
              EXPECT_EQ(rig.request(serial::Down::bus, bytes_of(125'000) + Bytes{0}), Status::ok);
              EXPECT_EQ(rig.request(serial::Down::bus, bytes_of(500'000) + Bytes{0}), Status::ok);
            }},
        Ending{
            "another_mode",
            [](BridgeRig& rig) {
              EXPECT_EQ(rig.request(serial::Down::bus, bytes_of(500'000) + Bytes{1}), Status::ok);
              EXPECT_EQ(rig.request(serial::Down::bus, bytes_of(500'000) + Bytes{0}), Status::ok);
            }},
        Ending{"a_lost_line_rate",
               [](BridgeRig& rig) {
                 EXPECT_EQ(rig.request(serial::Down::speed, bytes_of(1'000'000)), Status::ok);
                 rig.bus.run_for(400ms);
               }}),
    [](const auto& ending) { return ending.param.name; });

TEST_P(EndOfASession, NothingOfItIsSentLater) {
  BridgeRig rig;
  rig.hello();
  rig.set_peer(false);
  for (std::uint8_t i = 0; i < 8; ++i) {
    rig.send(extended(i == 7 ? urgent_id : normal_id, {i}));
  }
  rig.bus.run_for(50ms);
  GetParam().end(rig);
  rig.bus.run_for(20ms);
  EXPECT_TRUE(heard_when_the_peer_comes_back(rig).empty());
  // And what comes next goes.
  rig.hello(3);
  rig.send(extended(normal_id, {99}));
  rig.poll_for(50ms);
  ASSERT_EQ(rig.on_bus.size(), 1U);
  EXPECT_EQ(rig.on_bus[0].data[0], 99);
  EXPECT_EQ(outcome(rig, 0), serial::Outcome::sent);
}

// The bridge's own answers are no session's, and have a life, too.
TEST(LifeOfAFrame, AnAnswerOfItsOwnIsNotOld) {
  BridgeRig rig;
  rig.node.send({0x14000000 | 0xFEU << 13 | 9, FrameKind::extended, 2, {0x01, 0x02}});
  rig.node.on_sent([&](const Frame& /*frame*/) { rig.set_peer(false); });
  rig.bus.run_for(1500ms);
  rig.node.on_sent(nullptr);
  EXPECT_TRUE(heard_when_the_peer_comes_back(rig).empty());
  rig.node.send({0x14000000 | 0xFEU << 13 | 9, FrameKind::extended, 2, {0x01, 0x02}});
  rig.bus.run_for(20ms);
  EXPECT_EQ(rig.on_bus.size(), 1U) << "it does answer";
}

}  // namespace
}  // namespace roio::test
