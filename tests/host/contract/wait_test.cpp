// Timeouts, cancellation, closing, and the descriptor for other people's event loops.
#include <csignal>
#include <ctime>
#include <thread>

#include "contract.hpp"

namespace roio::test {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

ROIO_CONTRACT(Waits);

Result receive_one(Bus& bus, Timeout timeout) {
  Received received{};
  return bus.receive(received, timeout);
}

TEST_P(Waits, ReceiveEndsAtItsDeadlineAndNotBefore) {
  const auto bus = join();
  for (const Timeout timeout :
       {Timeout(milliseconds(-5)), no_wait, Timeout(1), Timeout(milliseconds(25))}) {
    const auto start = Clock::now();
    EXPECT_EQ(receive_one(*bus, timeout), Result::timeout);
    EXPECT_GE(Clock::now() - start, timeout);
  }
}

TEST_P(Waits, ReceiveWithoutRoomReturnsAtOnce) {
  const auto bus = join();
  const Transfer transfer = bus->receive(std::span<Received>(), forever);
  EXPECT_EQ(transfer.result, Result::timeout);
  EXPECT_EQ(transfer.count, 0U);
}

TEST_P(Waits, ReceiveForeverEndsWithAFrame) {
  const auto sender = join();
  const auto receiver = join();
  auto receiving = in_thread([&] { return receive_one(*receiver, forever); });
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  ASSERT_EQ(sender->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(result_of(receiving), Result::ok);
}

TEST_P(Waits, CancelEndsAReceiveThatWaits) {
  const auto bus = join();
  auto receiving = in_thread([&] { return receive_one(*bus, forever); });
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  bus->cancel();
  EXPECT_EQ(result_of(receiving), Result::cancelled);
}

TEST_P(Waits, CancelHoldsUntilResume) {
  const auto sender = join();
  const auto bus = join();
  bus->cancel();
  bus->cancel();
  EXPECT_EQ(receive_one(*bus, forever), Result::cancelled);
  EXPECT_EQ(receive_one(*bus, forever), Result::cancelled);
  bus->resume();
  EXPECT_EQ(receive_one(*bus, no_wait), Result::timeout);
  ASSERT_EQ(sender->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(receive_one(*bus, guard), Result::ok);
}

TEST_P(Waits, CancelledCallsStillDoWhatNeedsNoWait) {
  const auto peer = join();
  const auto bus = join();
  ASSERT_EQ(peer->send(numbered(1), guard), Result::ok);
  ASSERT_TRUE(is_readable(*bus, guard));
  bus->cancel();
  EXPECT_EQ(receive_one(*bus, forever), Result::ok) << "a frame was waiting";
  EXPECT_EQ(receive_one(*bus, forever), Result::cancelled);
  EXPECT_EQ(bus->send(numbered(2), forever), Result::ok) << "there was room";
  EXPECT_EQ(frames_of(receive_exactly(*peer, 1)), std::vector{numbered(2)});
}

Bus* bus_of_handler = nullptr;

TEST_P(Waits, CancelWorksFromASignalHandler) {
  const auto bus = join();
  bus_of_handler = bus.get();
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = [](int) { bus_of_handler->cancel(); };
  ASSERT_EQ(::sigaction(SIGUSR1, &action, &before), 0);
  std::promise<pthread_t> started;
  auto receiving = in_thread([&] {
    started.set_value(::pthread_self());
    return receive_one(*bus, forever);
  });
  const pthread_t thread = started.get_future().get();
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  ASSERT_EQ(::pthread_kill(thread, SIGUSR1), 0);
  EXPECT_EQ(result_of(receiving), Result::cancelled);
  ::sigaction(SIGUSR1, &before, nullptr);
  bus_of_handler = nullptr;
}

TEST_P(Waits, ASignalThatCancelsNothingEndsNoWait) {
  const auto bus = join();
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = [](int) {};
  ASSERT_EQ(::sigaction(SIGUSR1, &action, &before), 0);
  std::promise<pthread_t> started;
  auto receiving = in_thread([&] {
    started.set_value(::pthread_self());
    return receive_one(*bus, forever);
  });
  const pthread_t thread = started.get_future().get();
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  ASSERT_EQ(::pthread_kill(thread, SIGUSR1), 0);
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  bus->cancel();
  EXPECT_EQ(result_of(receiving), Result::cancelled);
  ::sigaction(SIGUSR1, &before, nullptr);
}

std::chrono::nanoseconds thread_cpu_time() {
  timespec used{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return std::chrono::seconds(used.tv_sec) + std::chrono::nanoseconds(used.tv_nsec);
}

TEST_P(Waits, SleepAlsoAfterWhatWokeAnEarlierOne) {
  const auto sender = join();
  const auto receiver = join();
  receiver->cancel();
  EXPECT_EQ(receive_one(*receiver, guard), Result::cancelled);
  receiver->resume();
  ASSERT_EQ(sender->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(receive_one(*receiver, guard), Result::ok);
  constexpr milliseconds wait{100};
  const auto before = thread_cpu_time();
  EXPECT_EQ(receive_one(*receiver, wait), Result::timeout);
  EXPECT_LT(thread_cpu_time() - before, wait / 4) << "it spins";
}

TEST_P(Waits, CloseEndsAReceiveThatWaits) {
  const auto bus = join();
  auto receiving = in_thread([&] { return receive_one(*bus, forever); });
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  bus->close();
  EXPECT_EQ(result_of(receiving), Result::closed);
}

TEST_P(Waits, AfterCloseEveryCallSaysClosed) {
  const auto peer = join();
  const auto bus = join();
  const int fd = bus->fd();
  ASSERT_EQ(peer->send(numbered(1), guard), Result::ok);
  ASSERT_TRUE(is_readable(*bus, guard));
  bus->close();
  bus->close();
  EXPECT_EQ(receive_one(*bus, forever), Result::closed) << "what was waiting is gone";
  EXPECT_EQ(receive_one(*bus, no_wait), Result::closed);
  EXPECT_EQ(bus->send(numbered(2), forever), Result::closed);
  const std::vector<Frame> frames{numbered(2), numbered(3)};
  const Transfer transfer = bus->send(frames, forever);
  EXPECT_EQ(transfer.result, Result::closed);
  EXPECT_EQ(transfer.count, 0U);
  EXPECT_EQ(bus->statistics().sent, 0U);
  EXPECT_EQ(bus->fd(), fd);
  EXPECT_FALSE(bus->name().empty());
  expect_silence(*peer);
}

TEST_P(Waits, CloseHandsOverWhatWasSent) {
  constexpr std::uint32_t count = 60;
  const auto receiver = join();
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    frames.push_back(numbered(i));
  }
  {
    const auto sender = join();
    send_all(*sender, frames);
    sender->close();
    EXPECT_EQ(sender->statistics().unsent, 0U);
  }
  EXPECT_EQ(frames_of(receive_exactly(*receiver, count)), frames);
}

TEST_P(Waits, TheOthersGoOnWhenOneLeaves) {
  const auto receiver = join();
  auto first = join();
  const auto second = join();
  ASSERT_EQ(first->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*receiver, 1)), std::vector{numbered(1)});
  first.reset();
  ASSERT_EQ(second->send(numbered(2), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*receiver, 1)), std::vector{numbered(2)});
}

TEST_P(Waits, DescriptorIsReadableWhileFramesWait) {
  const auto sender = join();
  const auto receiver = join();
  const int fd = receiver->fd();
  EXPECT_FALSE(is_readable(*receiver));
  send_all(*sender, {numbered(1), numbered(2)});
  ASSERT_TRUE(is_readable(*receiver, guard));
  receive_exactly(*receiver, 1);
  ASSERT_TRUE(is_readable(*receiver, guard)) << "one more waits";
  receive_exactly(*receiver, 1);
  while (receive_one(*receiver, no_wait) == Result::ok) {
  }
  EXPECT_FALSE(is_readable(*receiver));
  ASSERT_EQ(sender->send(numbered(3), guard), Result::ok);
  EXPECT_TRUE(is_readable(*receiver, guard)) << "and again";
  EXPECT_EQ(receiver->fd(), fd);
}

TEST_P(Waits, OneThreadMaySendWhileAnotherReceives) {
  constexpr std::uint32_t count = 500;
  const auto a = join();
  const auto b = join();
  // Each has an identifier of its own, as CAN asks of senders: of equal frames that start together,
  // a wire makes one.
  const auto exchange = [](Bus& bus, std::uint32_t id) {
    return in_thread([&bus, id] {
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(bus.send(numbered(i, id), guard), Result::ok);
      }
    });
  };
  auto from_a = exchange(*a, 0x1000400A);
  auto from_b = exchange(*b, 0x1000400B);
  auto at_a = in_thread([&] { return receive_exactly(*a, count).size(); });
  auto at_b = in_thread([&] { return receive_exactly(*b, count).size(); });
  EXPECT_EQ(result_of(at_a), count);
  EXPECT_EQ(result_of(at_b), count);
  result_of(from_a);
  result_of(from_b);
}

}  // namespace
}  // namespace roio::test
