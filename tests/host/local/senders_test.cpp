// A receiver takes each frame once, whoever brings it.
#include "local/senders.hpp"

#include <gtest/gtest.h>

namespace roio::local {
namespace {

TEST(Senders, AFrameIsNewOnce) {
  Senders senders;
  EXPECT_TRUE(senders.is_new(1, normal_lane, 1));
  EXPECT_FALSE(senders.is_new(1, normal_lane, 1));
  EXPECT_TRUE(senders.is_new(1, normal_lane, 2));
  EXPECT_FALSE(senders.is_new(1, normal_lane, 1)) << "older than one had";
}

TEST(Senders, FilteredFramesLeaveGapsThatAreNoDuplicates) {
  Senders senders;
  EXPECT_TRUE(senders.is_new(1, normal_lane, 5));
  EXPECT_TRUE(senders.is_new(1, normal_lane, 900));
}

TEST(Senders, LanesAndSendersAreCountedApart) {
  Senders senders;
  EXPECT_TRUE(senders.is_new(1, normal_lane, 7));
  EXPECT_TRUE(senders.is_new(1, urgent_lane, 7));
  EXPECT_TRUE(senders.is_new(2, normal_lane, 7));
}

TEST(Senders, TheOneNotHeardForLongestIsForgotten) {
  Senders senders;
  constexpr std::uint64_t kept = 4096;
  for (std::uint64_t sender = 0; sender < kept; ++sender) {
    EXPECT_TRUE(senders.is_new(sender, normal_lane, 1));
  }
  EXPECT_FALSE(senders.is_new(0, normal_lane, 1)) << "heard again, so 1 is the oldest now";
  EXPECT_TRUE(senders.is_new(kept, normal_lane, 1));
  EXPECT_FALSE(senders.is_new(0, normal_lane, 1));
  EXPECT_TRUE(senders.is_new(1, normal_lane, 1));
}

}  // namespace
}  // namespace roio::local
