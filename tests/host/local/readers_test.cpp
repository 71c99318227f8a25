// The hub's care for its readers, with time that moves only when a test says so: whom it wakes, and
// for whom the bus waits.
#include "local/readers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "local/log_reader.hpp"
#include "memory_rig.hpp"

namespace roio::local {
namespace {

using std::chrono::milliseconds;
using test::MemoryRig;

constexpr Readers::TimePoint start{std::chrono::hours(1)};
constexpr std::array everything{SocketCanFilter{0, 0}};
constexpr std::array only_two{SocketCanFilter{2, 0x7FF}};

class OneReader : public ::testing::Test {
 protected:
  void SetUp() override { memory_.readers().set_wake(0, &wake_); }

  bool is_woken() {
    const bool woken = wake_.is_set();
    wake_.clear();
    return woken;
  }
  void has_read_to(std::uint64_t number) { slot_.position = pack({number, 0}); }

  MemoryRig memory_;
  EventFlag wake_;
  Slot& slot_ = memory_.add_client(0, only_two);
  LogReader reader_{*memory_, slot_};
};

TEST_F(OneReader, IsWokenForAFrameThatItWantsWhenItSleeps) {
  memory_.carry(2);
  memory_.readers().wake_for_news();
  EXPECT_FALSE(is_woken()) << "it does not sleep";
  std::array<Carried, 1> frames;
  ASSERT_EQ(reader_.read(frames).count, 1U);
  ASSERT_TRUE(reader_.sleep());
  memory_.carry(3);
  memory_.carry(2, slot_.client);
  memory_.readers().wake_for_news();
  EXPECT_FALSE(is_woken()) << "another's, and its own";
  memory_.carry(2);
  memory_.readers().wake_for_news();
  EXPECT_TRUE(is_woken());
  ASSERT_EQ(reader_.read(frames).count, 1U);
  EXPECT_EQ(frames[0].sender, 1000U) << "it need not look at what it did not want";
  memory_.carry(2);
  memory_.readers().wake_for_news();
  EXPECT_FALSE(is_woken()) << "once is enough";
}

TEST_F(OneReader, IsWokenByItsFiltersOfNow) {
  ASSERT_TRUE(reader_.sleep());
  memory_.carry(3);
  memory_.readers().wake_for_news();
  ASSERT_FALSE(is_woken());
  publish_filters(slot_, everything);
  memory_.carry(3);
  memory_.readers().wake_for_news();
  EXPECT_TRUE(is_woken());
}

TEST_F(OneReader, IsWokenForEverythingWhileItsFiltersChange) {
  ASSERT_TRUE(reader_.sleep());
  slot_.filter_version = 7;  // it was killed in the middle
  memory_.carry(3);
  memory_.readers().wake_for_news();
  EXPECT_TRUE(is_woken());
}

TEST_F(OneReader, IsWokenForDoneOnlyWhereItAskedForThat) {
  memory_.readers().wake_for_done(0);
  EXPECT_FALSE(is_woken());
  slot_.awaits_done = 1;
  memory_.readers().wake_for_done(0);
  EXPECT_TRUE(is_woken());
  memory_.readers().wake_for_done(0);
  EXPECT_FALSE(is_woken()) << "once";
}

TEST_F(OneReader, HoldsTheBusWhenItLagsButNotBeyondItsPatience) {
  memory_.carry_many(max_lag, 3);
  EXPECT_FALSE(memory_.readers().hold_bus(start)) << "does not lag yet";
  memory_.carry(3);
  EXPECT_TRUE(memory_.readers().hold_bus(start));
  EXPECT_EQ(slot_.bus_waits, 1U) << "it is asked to tell";
  EXPECT_TRUE(memory_.readers().hold_bus(start + patience - milliseconds(1)));
  EXPECT_FALSE(memory_.readers().hold_bus(start + patience)) << "has not read for a patience";
}

TEST_F(OneReader, ReadingRenewsItsPatience) {
  memory_.carry_many(max_lag + 2000, 3);
  ASSERT_TRUE(memory_.readers().hold_bus(start));
  const auto later = start + patience;
  has_read_to(1024);
  EXPECT_FALSE(memory_.readers().hold_bus(later)) << "too slow to be waited for";
  has_read_to(1025);
  EXPECT_TRUE(memory_.readers().hold_bus(later));
  has_read_to(2001);
  EXPECT_FALSE(memory_.readers().hold_bus(later)) << "has caught up";
}

TEST_F(OneReader, AProgramThatDoesNotTakeWhatItsLibraryReadHoldsItToo) {
  slot_.queued = max_lag;
  EXPECT_FALSE(memory_.readers().hold_bus(start));
  slot_.queued = max_lag + 1;
  EXPECT_TRUE(memory_.readers().hold_bus(start));
  EXPECT_FALSE(memory_.readers().hold_bus(start + patience));
  slot_.consumed = 1024;
  EXPECT_TRUE(memory_.readers().hold_bus(start + patience));
}

TEST_F(OneReader, WhoDoesNotListenHoldsNobody) {
  publish_filters(slot_, {});
  slot_.queued = max_lag + 1;
  memory_.carry_many(max_lag + 1, 3);
  EXPECT_FALSE(memory_.readers().hold_bus(start));
  EXPECT_EQ(memory_.readers().listeners(), 0U);
}

TEST_F(OneReader, IsMovedOnOnlyAsFarAsTheLogNeeds) {
  memory_.carry_many(log_size + 1, 2);
  EXPECT_EQ(unpack(slot_.position).next, 1026U) << "a lot at once, so that it can read meanwhile";
  EXPECT_EQ(reader_.dropped(), 1025U);
  EXPECT_EQ(slot_.dropped, 1025U);
}

// A program that is broken, or means harm, changes its position all the time: the hub gets on.
TEST_F(OneReader, WhosePositionNeverRestsHoldsNobodyUp) {
  memory_.carry_many(log_size, 2);
  std::atomic<bool> begun{false};
  std::atomic<bool> over{false};
  std::thread restless([&] {
    for (std::uint64_t i = 0; !over; ++i) {
      slot_.position =
          pack({1 + (i >> 16) % 1000, static_cast<std::uint16_t>(i)});  // never twice the same soon
      begun = true;
    }
  });
  while (!begun) {
  }
  memory_.carry_many(20 * log_size, 2);
  over = true;
  restless.join();
  EXPECT_EQ(memory_->header.head, 21 * log_size);
}

}  // namespace
}  // namespace roio::local
