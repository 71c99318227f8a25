// Rings of buses: those that can be known before, and storms, which are noticed.
#include "attach/rings.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "attach/ring_watch.hpp"

namespace roio::cli {
namespace {

using std::chrono::milliseconds;

TEST(Rings, WhichJointClosesOne) {
  const std::vector<std::tuple<const char*, std::vector<Joint>, Joint, bool>> rows{
      {"the first", {}, {1, 2}, false},
      {"the same again", {{1, 2}}, {1, 2}, true},
      {"the other way round", {{1, 2}}, {2, 1}, true},
      {"a chain", {{1, 2}}, {2, 3}, false},
      {"a triangle", {{1, 2}, {2, 3}}, {3, 1}, true},
      {"a star", {{1, 2}, {1, 3}, {1, 4}}, {1, 5}, false},
      {"two leaves of a star", {{1, 2}, {1, 3}, {1, 4}}, {4, 2}, true},
      {"a long way, told in any order", {{5, 4}, {1, 2}, {3, 4}, {3, 2}}, {1, 5}, true},
      {"of others' rings", {{7, 8}, {8, 9}, {9, 7}}, {1, 2}, false},
      {"with itself", {}, {1, 1}, true},
  };
  for (const auto& [what, others, joint, expected] : rows) {
    EXPECT_EQ(closes_ring(others, joint), expected) << what;
  }
}

TEST(Rings, NamesOfJoints) {
  const Joint joint{0x123, 0xFEDCBA9876543210};
  EXPECT_EQ(name_of(joint), "roio-attach:0000000000000123-fedcba9876543210");
  EXPECT_EQ(name_of({joint.second, joint.first}), name_of(joint));
  const auto parsed = parse_joint(name_of(joint));
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->first, joint.first);
  EXPECT_EQ(parsed->second, joint.second);
  for (const char* other :
       {"", "roio-attach:", "roio-bridge-attach:vcan0", "roio-attach:0000000000000123",
        "roio-attach:0000000000000123-fedcba987654321",
        "roio-attach:0000000000000123-fedcba987654321g",
        "roio-attach:0000000000000123-fedcba98765432100"}) {
    EXPECT_FALSE(parse_joint(other)) << other;
  }
  EXPECT_NE(number_of("can:can0"), number_of("can:can1"));
}

TEST(Rings, JointsAmongAllSockets) {
  const std::string table =
      "Num       RefCount Protocol Flags    Type St Inode Path\n"
      "0000000000000000: 00000002 00000000 00010000 0001 01 21 /run/some@where\n"
      "0000000000000000: 00000002 00000000 00000000 0002 01 22 "
      "@roio-attach:0000000000000001-0000000000000002\n"
      "0000000000000000: 00000003 00000000 00000000 0001 03 23\n"
      "0000000000000000: 00000002 00000000 00000000 0002 01 24 "
      "@roio-attach:0000000000000002-0000000000000003";
  const std::vector<Joint> joints = joints_in(table);
  ASSERT_EQ(joints.size(), 2U);
  EXPECT_EQ(joints[0].second, 2U);
  EXPECT_EQ(joints[1].second, 3U);
  EXPECT_TRUE(joints_in("").empty());
}

/// Two buses, 0 and 1, and the watch between them.
class RingWatchTest : public testing::Test {
 protected:
  static Frame frame(std::uint32_t id, std::uint8_t data = 0) {
    return {id, FrameKind::extended, 1, {data}};
  }
  /// @return whether all is well.
  bool comes(std::size_t from, const Frame& frame, milliseconds after) {
    now_ += after;
    return watch_.pass(from, {&frame, 1}, now_);
  }

  RingWatch::Clock::time_point now_{std::chrono::hours(1)};
  RingWatch watch_;
};

TEST_F(RingWatchTest, AFrameThatGoesRoundIsAStorm) {
  // Something else hands it back: what goes to 1 comes from 1, what then goes to 0 comes from 0.
  int rounds = 0;
  while (rounds < 1000 && comes(static_cast<std::size_t>(rounds % 2), frame(5), milliseconds(1))) {
    ++rounds;
  }
  EXPECT_GE(rounds, 16 + 30 - 1);
  EXPECT_LT(rounds, 600);
}

TEST_F(RingWatchTest, SeveralCopiesAndOtherTrafficHideNothing) {
  bool well = true;
  for (int i = 0; i < 3000 && well; ++i) {
    for (const std::size_t from : {0U, 1U}) {
      for (const std::uint32_t id : {5U, 5U, 6U}) {
        well = well && comes(from, frame(id), {});
      }
    }
    if (i % 10 == 0) {
      well = well && comes(0, frame(9, static_cast<std::uint8_t>(i)), milliseconds(5));
    }
  }
  EXPECT_FALSE(well);
}

TEST_F(RingWatchTest, WhatIsNoStorm) {
  for (int i = 0; i < 5000; ++i) {
    ASSERT_TRUE(comes(0, frame(5), milliseconds(1))) << "the same again and again, one way";
  }
  for (int i = 0; i < 5000; ++i) {
    ASSERT_TRUE(comes(0, frame(5, static_cast<std::uint8_t>(i)), milliseconds(1)));
    ASSERT_TRUE(comes(1, frame(7, static_cast<std::uint8_t>(i)), {})) << "question and answer";
  }
  for (std::uint32_t i = 0; i < 5000; ++i) {
    ASSERT_TRUE(comes(0, frame(i), milliseconds(1)));
    ASSERT_TRUE(comes(1, frame(i), {})) << "a bridge in loopback mode: each comes back once";
  }
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(comes(0, frame(5), milliseconds(100)));
    ASSERT_TRUE(comes(1, frame(5), milliseconds(100))) << "two of one address, ten times a second";
  }
  for (std::uint32_t i = 0; i < 100 * 40; ++i) {
    const milliseconds after(i % 40 == 0 ? 1001 : 0);
    ASSERT_TRUE(comes(i / 40 % 2, frame(i % 40), after))
        << "what comes after more than a second has not gone round";
  }
  for (std::uint32_t i = 0; i < 5000; ++i) {
    ASSERT_TRUE(comes(i % 2, frame(5), milliseconds(1)));
    ASSERT_TRUE(comes(0, frame(7, static_cast<std::uint8_t>(i)), {}))
        << "two of one address, among other traffic";
  }
}

}  // namespace
}  // namespace roio::cli
