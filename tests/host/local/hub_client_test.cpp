// The hub's side of one client, with time that moves only when a test says so: whom the bus waits
// for.
#include "local/hub_client.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

namespace roio::local {
namespace {

using std::chrono::milliseconds;

constexpr HubClient::TimePoint start{std::chrono::hours(1)};
constexpr Frame some_frame{0x1004A00A, FrameKind::extended, 1, {7}};

class OneClient : public ::testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()), 0);
    other_end_ = UniqueFd(ends[1]);
    client_ = std::make_unique<HubClient>(UniqueFd(ends[0]), start);
    client_->welcome(std::make_shared<Station>(1), false, Welcome{0, 4096}, 0);
    std::array<std::uint8_t, 64> greeting{};
    receive_with_fd(other_end_.get(), greeting, page_fd_);
    page_.emplace(std::move(page_fd_));
  }

  void deliver(std::uint64_t count, HubClient::TimePoint now = start) {
    for (std::uint64_t i = 0; i < count; ++i) {
      ++number_;
      client_->deliver(Deliver{0, 2, number_, 0, to_wire(some_frame)}, number_, now);
    }
  }

  [[nodiscard]] std::uint64_t dropped() const { return page_->counters().dropped; }
  [[nodiscard]] std::uint64_t at_risk() const { return page_->counters().at_risk; }

  // More than any socket's buffer takes in one go.
  static constexpr std::uint64_t more_than_a_socket = 30'000;

  UniqueFd other_end_;
  UniqueFd page_fd_;
  std::optional<CounterPage> page_;
  std::unique_ptr<HubClient> client_;
  std::uint64_t number_ = 0;
};

TEST_F(OneClient, WantsNothingBeforeItsFilters) {
  EXPECT_FALSE(client_->wants(0x123));
  client_->set_filters({{0x123, 0x7FF}});
  EXPECT_TRUE(client_->wants(0x123));
  EXPECT_FALSE(client_->wants(0x124));
}

TEST_F(OneClient, QueueHoldsItsLimitAndCountsTheRest) {
  deliver(queue_limit);
  EXPECT_EQ(dropped(), 0U);
  deliver(3);
  EXPECT_EQ(dropped(), 3U);
  ASSERT_TRUE(client_->consumed(10, start));
  deliver(11);
  EXPECT_EQ(dropped(), 4U);
}

TEST_F(OneClient, HoldsTheBusWhenItLagsButNotBeyondItsPatience) {
  deliver(max_lag);
  EXPECT_FALSE(client_->holds_bus(start)) << "does not lag yet";
  deliver(1);
  EXPECT_TRUE(client_->holds_bus(start));
  EXPECT_TRUE(client_->holds_bus(start + patience - milliseconds(1)));
  EXPECT_FALSE(client_->holds_bus(start + patience)) << "has not read for a patience";
}

TEST_F(OneClient, ReadingRenewsItsPatience) {
  deliver(max_lag + 2000);
  const auto later = start + patience;
  ASSERT_TRUE(client_->consumed(1023, later));
  EXPECT_FALSE(client_->holds_bus(later)) << "too slow to be waited for";
  ASSERT_TRUE(client_->consumed(1024, later));
  EXPECT_TRUE(client_->holds_bus(later));
  ASSERT_TRUE(client_->consumed(2000, later));
  EXPECT_FALSE(client_->holds_bus(later)) << "has caught up";
}

TEST_F(OneClient, CannotConsumeWhatWasNotDelivered) {
  deliver(5);
  EXPECT_TRUE(client_->consumed(5, start));
  EXPECT_FALSE(client_->consumed(6, start));
  EXPECT_FALSE(client_->consumed(4, start)) << "nor take it back";
}

TEST_F(OneClient, SendersWaitForFramesThatItsSocketDoesNotTake) {
  deliver(1);
  ASSERT_TRUE(client_->flush(start));
  EXPECT_FALSE(client_->first_unflushed());
  EXPECT_FALSE(client_->holds_done(start, false));
  deliver(more_than_a_socket);
  ASSERT_TRUE(client_->flush(start));
  ASSERT_TRUE(client_->first_unflushed());
  EXPECT_GT(*client_->first_unflushed(), 1U);
  EXPECT_TRUE(client_->holds_done(start + patience - milliseconds(1), false));
  EXPECT_FALSE(client_->holds_done(start + patience, false)) << "not for longer than a patience";
  EXPECT_FALSE(client_->holds_done(start, true)) << "a bus with a bit rate waits for nobody";
}

TEST_F(OneClient, FramesReportedDoneAndNotSentAreAtRisk) {
  deliver(more_than_a_socket);
  ASSERT_TRUE(client_->flush(start));
  const std::uint64_t first = *client_->first_unflushed();
  client_->note_risk(first - 1);
  EXPECT_EQ(at_risk(), 0U);
  client_->note_risk(first);
  EXPECT_EQ(at_risk(), 1U);
  client_->note_risk(number_);
  EXPECT_EQ(at_risk(), number_ - first + 1);
}

TEST_F(OneClient, AClientThatDoesNotGreetIsOverdue) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
  const UniqueFd other_end(ends[1]);
  const HubClient silent{UniqueFd(ends[0]), start};
  EXPECT_FALSE(silent.greeting_overdue(start + std::chrono::seconds(5)));
  EXPECT_TRUE(silent.greeting_overdue(start + std::chrono::milliseconds(5001)));
  EXPECT_FALSE(client_->greeting_overdue(start + std::chrono::hours(1))) << "this one has";
}

}  // namespace
}  // namespace roio::local
