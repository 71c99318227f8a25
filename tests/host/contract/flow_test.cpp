// What happens when there is more than fits: waits end when they should, and every frame is
// accounted for.
#include <algorithm>
#include <array>

#include "contract.hpp"

namespace roio::test {
namespace {

using std::chrono::milliseconds;

ROIO_CONTRACT(Flow);

TEST_P(Flow, CountersAddUp) {
  constexpr std::uint32_t count = 500;
  const auto a = join();
  const auto b = join();
  for (std::uint32_t i = 0; i < count; ++i) {
    ASSERT_EQ(a->send(numbered(i), guard), Result::ok);
  }
  receive_exactly(*b, count);
  ASSERT_EQ(b->send(numbered(0), guard), Result::ok);
  receive_exactly(*a, 1);
  EXPECT_EQ(a->statistics().sent, count);
  EXPECT_EQ(a->statistics().received, 1U);
  EXPECT_EQ(b->statistics().sent, 1U);
  EXPECT_EQ(b->statistics().received, count);
  for (const Bus* bus : {a.get(), b.get()}) {
    const Statistics statistics = bus->statistics();
    EXPECT_EQ(statistics.dropped, 0U);
    EXPECT_EQ(statistics.send_timeouts, 0U);
    EXPECT_EQ(statistics.unsent, 0U);
    EXPECT_EQ(statistics.outages, 0U);
    EXPECT_EQ(bus->state(), BusState::active);
  }
}

/// Takes what has come in, and checks that the gaps between the numbers are the losses told.
class Tally {
 public:
  void take(Bus& bus, Timeout timeout) {
    const Transfer transfer = bus.receive(batch_, timeout);
    for (std::size_t i = 0; i < transfer.count; ++i) {
      const std::uint64_t number = number_of(batch_.at(i).frame);
      EXPECT_GE(number, next_) << "out of order, or twice";
      EXPECT_EQ(batch_.at(i).lost_before, number - next_) << "before number " << number;
      next_ = number + 1;
    }
  }
  /// How many of the frames sent are known to be received or lost.
  [[nodiscard]] std::uint64_t accounted() const { return next_; }

 private:
  std::array<Received, 256> batch_{};
  std::uint64_t next_ = 0;
};

TEST_P(Flow, AReceiverThatDoesNotReadIsToldWhatItMissed) {
  const auto sender = join({.send_only = true});
  const auto receiver = join();
  std::vector<Frame> flood;
  for (std::uint32_t i = 0; i < GetParam().flood; ++i) {
    flood.push_back(numbered(i));
  }
  send_all(*sender, flood);
  Tally tally;
  const auto end = std::chrono::steady_clock::now() + guard;
  auto sent = static_cast<std::uint32_t>(flood.size());
  // A loss is told with the frame after it: more frames are sent until the last one has come.
  while (tally.accounted() < sent && !testing::Test::HasFailure()) {
    ASSERT_LT(std::chrono::steady_clock::now(), end);
    const std::uint64_t before = tally.accounted();
    tally.take(*receiver, moment);
    if (tally.accounted() == before) {
      send_all(*sender, {numbered(sent++)});
    }
  }
  EXPECT_EQ(sender->statistics().sent, sent);
  const Statistics statistics = receiver->statistics();
  EXPECT_EQ(statistics.received + statistics.dropped, sent);
  std::cout << GetParam().name << ": " << statistics.dropped << " of " << sent << " dropped\n";
}

ROIO_CONTRACT_WHERE(FullQueue, paced);

/// More than any queue takes, in seconds of bus time.
std::vector<Frame> too_many() {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    frames.push_back(numbered(i));
  }
  return frames;
}

TEST_P(FullQueue, SendEndsAtItsDeadlineAndTellsHowFarItCame) {
  const auto sender = join();
  const auto receiver = join();
  const std::vector<Frame> frames = too_many();
  const Transfer transfer = sender->send(frames, milliseconds(20));
  EXPECT_EQ(transfer.result, Result::timeout);
  ASSERT_GT(transfer.count, 0U);
  ASSERT_LT(transfer.count, frames.size());
  const auto sent = static_cast<std::ptrdiff_t>(transfer.count);
  EXPECT_EQ(frames_of(receive_exactly(*receiver, transfer.count)),
            std::vector(frames.begin(), frames.begin() + sent));
  expect_silence(*receiver);
  const Statistics statistics = sender->statistics();
  EXPECT_EQ(statistics.sent, transfer.count);
  EXPECT_EQ(statistics.send_timeouts, 1U);
  EXPECT_GE(statistics.send_waits, 1U);
}

// A process may find its deadline past before it has begun to wait: with a nanosecond it always
// does.
TEST_P(FullQueue, AWaitIsCountedHoweverLateTheProcessIs) {
  const auto sender = join();
  const auto receiver = join();
  const Transfer transfer = sender->send(too_many(), std::chrono::nanoseconds(1));
  EXPECT_EQ(transfer.result, Result::timeout);
  EXPECT_GE(sender->statistics().send_waits, 1U);
  EXPECT_EQ(sender->statistics().send_timeouts, 1U);
  EXPECT_EQ(receive_exactly(*receiver, transfer.count).size(), transfer.count);
}

TEST_P(FullQueue, WithoutWaitTakesWhatFits) {
  const auto sender = join();
  const auto receiver = join();
  const Transfer transfer = sender->send(too_many(), no_wait);
  EXPECT_EQ(transfer.result, Result::timeout);
  EXPECT_GT(transfer.count, 0U);
  EXPECT_EQ(receive_exactly(*receiver, transfer.count).size(), transfer.count);
  EXPECT_EQ(sender->send(numbered(0), guard), Result::ok) << "room has come";
}

TEST_P(FullQueue, CancelEndsASendThatWaits) {
  const auto sender = join();
  const auto receiver = join();
  auto sending = in_thread([&] { return sender->send(too_many(), forever); });
  receive_exactly(*receiver, 1);
  sender->cancel();
  const Transfer transfer = result_of(sending);
  EXPECT_EQ(transfer.result, Result::cancelled);
  EXPECT_GT(transfer.count, 0U);
  EXPECT_EQ(sender->statistics().send_timeouts, 0U);
  receive_exactly(*receiver, transfer.count - 1);
  sender->resume();
  EXPECT_EQ(sender->send(numbered(0), guard), Result::ok);
}

TEST_P(FullQueue, CloseEndsASendThatWaits) {
  const auto sender = join();
  const auto receiver = join();
  auto sending = in_thread([&] { return sender->send(too_many(), forever); });
  receive_exactly(*receiver, 1);
  sender->close();
  const Transfer transfer = result_of(sending);
  EXPECT_EQ(transfer.result, Result::closed);
  const Statistics statistics = sender->statistics();
  EXPECT_EQ(statistics.sent, transfer.count);
  EXPECT_EQ(receive_exactly(*receiver, transfer.count - statistics.unsent - 1).size() + 1,
            transfer.count - statistics.unsent)
      << "what was accepted has been handed over, but for what is counted";
}

}  // namespace
}  // namespace roio::test
