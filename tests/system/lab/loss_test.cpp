// What the kernel had no room for is counted to the frame, and told where it happened.
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <numeric>
#include <roio.hpp>
#include <thread>
#include <vector>

#include "lab_support.hpp"

namespace roio::lab {
namespace {

/// While it lives, this thread may not exceed the receive buffer that everybody gets.
class WithoutNetAdmin {
 public:
  WithoutNetAdmin() {
    get(saved_);
    auto reduced = saved_;
    reduced[0].effective &= ~(1U << CAP_NET_ADMIN);
    set(reduced);
  }
  WithoutNetAdmin(const WithoutNetAdmin&) = delete;
  WithoutNetAdmin& operator=(const WithoutNetAdmin&) = delete;
  ~WithoutNetAdmin() { set(saved_); }

 private:
  using Data = std::array<__user_cap_data_struct, 2>;
  static void get(Data& data) {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    EXPECT_EQ(::syscall(SYS_capget, &header, data.data()), 0);
  }
  static void set(const Data& data) {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    EXPECT_EQ(::syscall(SYS_capset, &header, data.data()), 0);
  }
  Data saved_{};
};

std::unique_ptr<Bus> open_with_small_queue() {
  const WithoutNetAdmin reduced;
  return open("vcan0");
}

std::uint64_t sum_of_losses(const std::vector<Received>& received) {
  return std::accumulate(
      received.begin(), received.end(), std::uint64_t{0},
      [](std::uint64_t sum, const Received& one) { return sum + one.lost_before; });
}

using LossTest = LabTest;

TEST_F(LossTest, AnOverrunReceiverCountsWhatCangenSentInVain) {
  constexpr std::uint64_t sent = 5000;
  const auto bus = open_with_small_queue();
  shell("cangen vcan0 -g 0 -e -n " + std::to_string(sent));

  const std::uint64_t dropped = bus->statistics().dropped;  // known before anything is received
  EXPECT_GT(dropped, 0U);
  const auto received = receive_all(*bus);
  EXPECT_EQ(received.size() + dropped, sent);
  EXPECT_EQ(bus->statistics().received, received.size());
  EXPECT_EQ(bus->statistics().dropped, dropped);
  EXPECT_EQ(sum_of_losses(received), 0U) << "all that waited came before the first loss";

  shell("cansend vcan0 123#");
  const auto next = receive_exactly(*bus, 1);
  ASSERT_EQ(next.size(), 1U);
  EXPECT_EQ(next[0].lost_before, dropped) << "the loss is told by the first frame after it";
}

TEST_F(LossTest, LossesInTheMidstOfTheFloodAddUp) {
  const auto bus = open_with_small_queue();
  const auto sender = open("vcan0");
  std::vector<Received> received;
  std::uint64_t sent = 0;
  for (const std::size_t burst : {1000U, 10U, 2000U, 1U}) {
    ASSERT_EQ(sender->send(numbered_frames(0, burst), patience).result, Result::ok);
    sent += burst;
    const auto part = receive_all(*bus);
    received.insert(received.end(), part.begin(), part.end());
  }
  const Statistics statistics = bus->statistics();
  EXPECT_GT(statistics.dropped, 0U);
  EXPECT_EQ(statistics.received, received.size());
  EXPECT_EQ(statistics.received + statistics.dropped, sent);
  EXPECT_EQ(sum_of_losses(received), statistics.dropped);
}

TEST_F(LossTest, AReaderDuringTheFloodMissesWhatIsCountedAndNothingElse) {
  constexpr std::uint64_t sent = 20000;
  const auto bus = open_with_small_queue();
  Peer cangen("cangen vcan0 -g 0 -e -I i -L 8 -n " + std::to_string(sent));
  const auto received = receive_all(*bus, patience);
  EXPECT_EQ(cangen.wait(), 0);
  const auto rest = receive_all(*bus);
  EXPECT_EQ(received.size() + rest.size() + bus->statistics().dropped, sent);
}

TEST_F(LossTest, FramesThatTheFilterRejectsAreNoLoss) {
  const auto bus = open_with_small_queue();
  bus->set_filters(std::array{SocketCanFilter{0x123, 0x7FF}});
  const auto sender = open("vcan0");
  ASSERT_EQ(sender->send(numbered_frames(0, 3000), patience).result, Result::ok);
  EXPECT_EQ(bus->statistics().dropped, 0U);
}

TEST_F(LossTest, TheQueueHoldsFarMoreThanCandumpsWhereThatIsAllowed) {
  constexpr std::size_t burst = 20000;  // candump's queue: 278
  const auto bus = open("vcan0");
  const auto sender = open("vcan0");
  ASSERT_EQ(sender->send(numbered_frames(0, burst), patience).result, Result::ok);
  EXPECT_EQ(receive_exactly(*bus, burst).size(), burst);
  EXPECT_EQ(bus->statistics().dropped, 0U);
}

// --- a slow link ------------------------------------------------------------------------------

class SlowLinkTest : public LabTestThatChangesTheInterface {
 protected:
  /// A queue of `frames` before a link that sends some 1,500 frames/s after the first 10.
  static void make_slow(int frames) {
    shell("tc qdisc replace dev vcan0 root tbf rate 200kbit burst 160 limit " +
          std::to_string(16 * frames));
  }
};

TEST_F(SlowLinkTest, FillingItLosesNothingAndKeepsTheOrder) {
  make_slow(200);
  const auto bus = open("vcan0");
  const auto listener = open("vcan0");
  const auto frames = numbered_frames(0, 500);
  const Transfer sent = bus->send(frames, patience);
  EXPECT_EQ(sent.result, Result::ok);
  EXPECT_EQ(sent.count, frames.size());
  EXPECT_EQ(texts(receive_exactly(*listener, frames.size())), texts(frames));
  const Statistics statistics = bus->statistics();
  EXPECT_EQ(statistics.sent, frames.size());
  EXPECT_GT(statistics.send_waits, 0U);
  EXPECT_EQ(statistics.send_timeouts, 0U);
  EXPECT_EQ(listener->statistics().dropped, 0U);
}

// A queue shorter than what one socket may have under way: ENOBUFS, of which poll() knows nothing.
TEST_F(SlowLinkTest, AQueueShorterThanTheSocketsOwnLosesNothingEither) {
  make_slow(2);
  const auto bus = open("vcan0");
  const auto listener = open("vcan0");
  const auto frames = numbered_frames(0, 300);
  EXPECT_EQ(bus->send(frames, patience).result, Result::ok);
  EXPECT_EQ(texts(receive_exactly(*listener, frames.size())), texts(frames));
  EXPECT_GT(bus->statistics().send_waits, 0U);
}

TEST_F(SlowLinkTest, WhatDoesNotGoByTheDeadlineIsNotSentLater) {
  make_slow(200);
  const auto bus = open("vcan0");
  const auto listener = open("vcan0");
  const auto frames = numbered_frames(0, 500);
  const Transfer at_once = bus->send(frames, no_wait);
  EXPECT_EQ(at_once.result, Result::timeout);
  EXPECT_LT(at_once.count, 50U) << "the socket is full well before the queue of 200 is";
  const auto rest = std::span(frames).subspan(at_once.count);
  const Transfer later = bus->send(rest, std::chrono::milliseconds(50));
  EXPECT_EQ(later.result, Result::timeout);
  EXPECT_GT(later.count, 0U);
  const std::size_t count = at_once.count + later.count;
  const std::vector<Frame> went(frames.begin(), frames.begin() + static_cast<long>(count));
  EXPECT_EQ(texts(receive_all(*listener, patience)), texts(went));
  EXPECT_EQ(bus->statistics().sent, count);
  EXPECT_EQ(bus->statistics().send_timeouts, 2U);
}

TEST_F(SlowLinkTest, TwoSendersShareItAndBothGetThrough) {
  make_slow(4);
  const auto first = open("vcan0");
  const auto second = open("vcan0");
  const auto listener = open("vcan0");
  const auto own = numbered_frames(0, 200);
  const auto other = numbered_frames(0x1000, 200);
  std::thread thread([&] { EXPECT_EQ(second->send(other, patience).result, Result::ok); });
  EXPECT_EQ(first->send(own, patience).result, Result::ok);
  thread.join();
  std::vector<Frame> seen_own;
  std::vector<Frame> seen_other;
  for (const Received& one : receive_exactly(*listener, own.size() + other.size())) {
    (one.frame.id < 0x1000 ? seen_own : seen_other).push_back(one.frame);
  }
  EXPECT_EQ(texts(seen_own), texts(own));
  EXPECT_EQ(texts(seen_other), texts(other));
}

TEST_F(SlowLinkTest, CancelAndCloseEndAWaitForRoom) {
  make_slow(2);
  shell("tc qdisc replace dev vcan0 root tbf rate 1kbit burst 160 limit 32");
  const auto bus = open("vcan0");
  const auto frames = numbered_frames(0, 500);
  std::thread canceller([&] {
    EXPECT_TRUE(eventually([&] { return bus->statistics().send_waits > 0; }));
    bus->cancel();
  });
  EXPECT_EQ(bus->send(frames, forever).result, Result::cancelled);
  canceller.join();
  bus->resume();
  const std::uint64_t waits = bus->statistics().send_waits;
  std::thread closer([&] {
    EXPECT_TRUE(eventually([&] { return bus->statistics().send_waits > waits; }));
    bus->close();
  });
  EXPECT_EQ(bus->send(frames, forever).result, Result::closed);
  closer.join();
  EXPECT_EQ(bus->send(frames, forever).result, Result::closed);
}

}  // namespace
}  // namespace roio::lab
