// A client's frames on their way: what is offered again to the next hub, and what is not.
#include "local/outbox.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace roio::local {
namespace {

constexpr Frame normal{0x1004A00A, FrameKind::extended, 0, {}};
constexpr Frame urgent{0x0004A00A, FrameKind::extended, 0, {}};

std::vector<std::uint64_t> sequences(const Buffer& bytes) {
  std::vector<std::uint64_t> found;
  std::span<const std::uint8_t> rest = bytes;
  Record record{};
  while (take_record(rest, record) == Split::record) {
    found.push_back(record.as<OfferedFrame>().sequence);
  }
  return found;
}

class AnOutbox : public ::testing::Test {
 protected:
  void SetUp() override { outbox_.begin(3); }

  void done(std::size_t lane, std::uint64_t sequence) {
    slot_->done.at(lane) = sequence;
    outbox_.settle(*slot_);
  }

  Outbox outbox_{false};
  Buffer out_;
  std::unique_ptr<Slot> slot_ = std::make_unique<Slot>();
};

TEST_F(AnOutbox, TakesAsManyAsItsWindowInEachLane) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(outbox_.offer(normal, out_));
    EXPECT_TRUE(outbox_.offer(urgent, out_));
  }
  EXPECT_FALSE(outbox_.offer(normal, out_));
  EXPECT_FALSE(outbox_.offer(urgent, out_));
  EXPECT_EQ(sequences(out_), (std::vector<std::uint64_t>{1, 1, 2, 2, 3, 3}));
  done(normal_lane, 1);
  EXPECT_TRUE(outbox_.offer(normal, out_));
  EXPECT_FALSE(outbox_.offer(urgent, out_)) << "the other lane's room is its own";
}

TEST_F(AnOutbox, OffersToTheNextHubWhatIsNotInTheLog) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(outbox_.offer(normal, out_));
  }
  done(normal_lane, 2);
  outbox_.begin(3);
  Buffer again;
  EXPECT_EQ(outbox_.offer_again(again), 1U);
  EXPECT_EQ(sequences(again), (std::vector<std::uint64_t>{3}));
  EXPECT_EQ(outbox_.offer_again(again), 0U) << "once";
  done(normal_lane, 3);
  EXPECT_EQ(outbox_.size(), 0U);
}

TEST_F(AnOutbox, OffersNoMoreAgainThanMayBeOnTheirWay) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(outbox_.offer(normal, out_));
  }
  outbox_.begin(2);
  Buffer again;
  EXPECT_EQ(outbox_.offer_again(again), 2U);
  EXPECT_FALSE(outbox_.offer(normal, again));
  done(normal_lane, 1);
  EXPECT_EQ(outbox_.offer_again(again), 1U);
  EXPECT_EQ(sequences(again), (std::vector<std::uint64_t>{1, 2, 3}));
}

TEST(AnOutboxInOrder, HasOneLane) {
  Outbox outbox(true);
  outbox.begin(3);
  Buffer out;
  ASSERT_TRUE(outbox.offer(normal, out));
  ASSERT_TRUE(outbox.offer(urgent, out));
  EXPECT_EQ(sequences(out), (std::vector<std::uint64_t>{1, 2}));
}

}  // namespace
}  // namespace roio::local
