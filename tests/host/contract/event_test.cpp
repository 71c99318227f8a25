// What another program's event loop needs: everything that a call could wait for is told by
// event_fd() and take_events(), once, and nothing else is.
#include <algorithm>
#include <array>
#include <atomic>
#include <roio/node.hpp>
#include <system_error>
#include <thread>

#include "contract.hpp"
#include "event_loop.hpp"

namespace roio::test {
namespace {

ROIO_CONTRACT(EventLoop);

TEST_P(EventLoop, NothingIsToldWhereNothingHappens) {
  const auto a = join();
  const auto b = join();
  EXPECT_NE(a->event_fd(), a->fd());
  EXPECT_EQ(a->take_events(), Events{}) << "opening it is no event";
  ASSERT_EQ(a->send(numbered(1), guard), Result::ok);
  receive_exactly(*b, 1);
  ASSERT_EQ(b->send(numbered(2), no_wait), Result::ok);
  receive_exactly(*a, 1);
  a->cancel();
  a->resume();
  EXPECT_EQ(a->trouble(), std::nullopt);
  expect_no_events(*a);
  expect_no_events(*b);
}

TEST_P(EventLoop, TheDescriptorStaysTheSame) {
  const auto bus = join();
  const int fd = bus->event_fd();
  bus->begin_set_filters({});
  EXPECT_EQ(next_events(*bus), (Events{.filters = true}));
  bus->close();
  EXPECT_EQ(bus->event_fd(), fd);
}

TEST_P(EventLoop, FiltersHoldWhenItIsTold) {
  const auto sender = join();
  const auto bus = join({.send_only = true});
  const SocketCanFilter wanted{0x123, 0xC00007FF};
  bus->begin_set_filters(std::span(&wanted, 1));
  EXPECT_EQ(next_events(*bus), (Events{.filters = true}));
  expect_no_events(*bus);
  send_all(*sender, {{0x124, FrameKind::standard, 0, {}}, {0x123, FrameKind::standard, 0, {}}});
  EXPECT_EQ(frames_of(receive_exactly(*bus, 1)),
            (std::vector<Frame>{{0x123, FrameKind::standard, 0, {}}}));
  expect_silence(*bus);
}

TEST_P(EventLoop, TooManyFiltersAreRefusedAtOnce) {
  const auto bus = join();
  const std::vector<SocketCanFilter> filters(513);
  EXPECT_THROW(bus->begin_set_filters(filters), std::system_error);
  EXPECT_THROW(bus->set_filters(filters), std::system_error);
  expect_no_events(*bus);
}

TEST_P(EventLoop, SettingFiltersWithAWaitTellsNothing) {
  const auto bus = join();
  bus->set_filters({});
  expect_no_events(*bus);
}

TEST_P(EventLoop, ANodeNeedNotWaitForItsFilters) {
  Node sender(join(), Address{0, 10});
  Node node(join(), Address{0, 2}, {.background = true});
  EXPECT_EQ(next_events(node.bus()), (Events{.filters = true}));
  ASSERT_EQ(sender.send({0, 2}, {}), Result::ok);
  ReceivedMessage message{};
  EXPECT_EQ(node.receive(message, guard), Result::ok);
}

TEST_P(EventLoop, CloseIsToldOnce) {
  const auto bus = join();
  bus->begin_close();
  bus->begin_close();
  Events events = next_events(*bus);
  while (!events.closed && !HasFailure()) {  // state may be told before
    events = next_events(*bus);
  }
  EXPECT_EQ(bus->send(numbered(1), forever), Result::closed);
  Received received{};
  EXPECT_EQ(bus->receive(received, forever), Result::closed);
  expect_no_events(*bus);
  bus->close();
  expect_no_events(*bus);
}

TEST_P(EventLoop, CloseWithAWaitIsToldToo) {
  const auto bus = join();
  bus->close();
  EXPECT_TRUE(bus->take_events().closed);
}

TEST_P(EventLoop, WhatIsToldAndNotTakenOutlivesTheClose) {
  const auto bus = join();
  bus->begin_set_filters({});
  ASSERT_TRUE(has_events(*bus, guard));
  bus->close();
  const Events events = bus->take_events();
  EXPECT_TRUE(events.filters);
  EXPECT_TRUE(events.closed);
}

TEST_P(EventLoop, CallsThatBeginInAnotherThreadEndWithTheClose) {
  const auto bus = join();
  auto receiving = in_thread([&] {
    Received received{};
    return bus->receive(received, forever);
  });
  EXPECT_EQ(receiving.wait_for(moment), std::future_status::timeout);
  bus->begin_close();
  EXPECT_EQ(result_of(receiving), Result::closed);
}

TEST_P(EventLoop, TwoThreadsMayCloseAtOnce) {
  for (int i = 0; i < 5; ++i) {
    const auto bus = join();
    auto first = in_thread([&] { bus->close(); });
    auto second = in_thread([&] { bus->close(); });
    result_of(first);
    result_of(second);
    EXPECT_TRUE(bus->take_events().closed) << "close() has returned";
  }
}

TEST_P(EventLoop, BeginningToCloseHandsOverWhatWasSent) {
  constexpr std::uint32_t count = 60;
  const auto receiver = join();
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    frames.push_back(numbered(i));
  }
  const auto sender = join();
  send_all(*sender, frames);
  sender->begin_close();
  EXPECT_EQ(frames_of(receive_exactly(*receiver, count)), frames);
  while (!next_events(*sender).closed && !HasFailure()) {
  }
  EXPECT_EQ(sender->statistics().unsent, 0U);
}

TEST_P(EventLoop, ABusThatIsThereIsOpenedInTheBackground) {
  const auto peer = join();
  const auto bus = join({.background = true});
  while (bus->state() != BusState::active && !HasFailure()) {
    EXPECT_TRUE(next_events(*bus).state);
  }
  EXPECT_EQ(bus->trouble(), std::nullopt);
  ASSERT_EQ(peer->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*bus, 1)), std::vector{numbered(1)});
  ASSERT_EQ(bus->send(numbered(2), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*peer, 1)), std::vector{numbered(2)});
}

TEST_P(EventLoop, ABusThatIsOpenedInTheBackgroundMayBeClosedAtOnce) {
  const auto peer = join();
  for (int i = 0; i < 3; ++i) {
    const auto bus = join({.background = true});
    bus->begin_close();
    while (!next_events(*bus).closed && !HasFailure()) {
    }
  }
}

TEST_P(EventLoop, LossesAreTold) {
  const auto sender = join({.send_only = true});
  const auto receiver = join();
  bool told = false;
  // Each backend has room for another number; it reads nothing until something is told or all are
  // sent.
  for (std::uint32_t i = 0; i < GetParam().flood; i += 1000) {
    std::vector<Frame> frames;
    for (std::uint32_t j = i; j < std::min<std::size_t>(i + 1000, GetParam().flood); ++j) {
      frames.push_back(numbered(j));
    }
    send_all(*sender, frames);
  }
  std::array<Received, 256> batch{};
  Transfer transfer{};
  do {
    transfer = receiver->receive(batch, moment);
    told = receiver->take_events().loss || told;
  } while (transfer.result == Result::ok);
  EXPECT_EQ(told, receiver->statistics().dropped > 0);
  expect_no_events(*receiver);
}

ROIO_CONTRACT_WHERE(EventsOfRoom, paced);

std::vector<Frame> many(std::uint32_t first, std::uint32_t count) {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    frames.push_back(numbered(first + i));
  }
  return frames;
}

TEST_P(EventsOfRoom, ASendThatNeverWaitsGoesOnWhenThereIsRoom) {
  constexpr std::uint32_t count = 500;
  const auto sender = join();
  const auto receiver = join();
  auto receiving = in_thread([&] { return frames_of(receive_exactly(*receiver, count)); });
  const std::vector<Frame> frames = many(0, count);
  std::size_t sent = 0;
  unsigned rounds = 0;
  while (sent < count && !HasFailure()) {
    const Transfer transfer = sender->send(std::span(frames).subspan(sent), no_wait);
    sent += transfer.count;
    if (transfer.result == Result::timeout) {
      EXPECT_TRUE(next_events(*sender).room);
      ++rounds;
    }
  }
  EXPECT_EQ(result_of(receiving), frames);
  EXPECT_GT(rounds, 0U) << "it never was full";
  expect_no_events(*sender);
}

TEST_P(EventsOfRoom, RoomIsToldOnceAndOnlyAfterASendThatFoundNone) {
  const auto sender = join();
  const auto receiver = join();
  ASSERT_EQ(sender->send(many(0, 20), guard).result, Result::ok);
  receive_exactly(*receiver, 20);
  expect_no_events(*sender);
  const Transfer transfer = sender->send(many(20, 5000), no_wait);
  ASSERT_EQ(transfer.result, Result::timeout);
  receive_exactly(*receiver, transfer.count);
  EXPECT_EQ(next_events(*sender), (Events{.room = true}));
  expect_no_events(*sender);
}

TEST_P(EventsOfRoom, AnotherThreadMaySendMeanwhile) {
  constexpr std::uint32_t count = 400;
  const auto sender = join();
  const auto receiver = join();
  std::atomic<bool> over{false};
  std::atomic<unsigned> rooms{0};
  std::thread loop([&] {
    while (!over) {
      if (has_events(*sender, moment) && sender->take_events().room) {
        ++rooms;
      }
    }
  });
  auto receiving = in_thread([&] { return receive_exactly(*receiver, count).size(); });
  std::size_t sent = 0;
  unsigned full = 0;
  while (sent < count) {
    const auto left = static_cast<std::uint32_t>(count - sent);
    const Transfer transfer =
        sender->send(many(static_cast<std::uint32_t>(sent), left), std::chrono::milliseconds(1));
    sent += transfer.count;
    full += transfer.result == Result::timeout ? 1U : 0U;
  }
  EXPECT_EQ(result_of(receiving), count);
  over = true;
  loop.join();
  EXPECT_LE(rooms + (sender->take_events().room ? 1U : 0U), full);
  EXPECT_GT(full, 0U);
}

TEST_P(EventsOfRoom, CloseWhileRoomIsAwaited) {
  const auto sender = join();
  const auto receiver = join();
  ASSERT_EQ(sender->send(many(0, 5000), no_wait).result, Result::timeout);
  sender->begin_close();
  while (!next_events(*sender).closed && !HasFailure()) {
  }
  expect_no_events(*sender);
  const Statistics statistics = sender->statistics();
  EXPECT_EQ(receive_exactly(*receiver, statistics.sent - statistics.unsent).size(),
            statistics.sent - statistics.unsent);
}

ROIO_CONTRACT_WHERE(OpenedAtOnce, there_at_once);

TEST_P(OpenedAtOnce, WithoutWaitingWhenTheBusIsThere) {
  const auto peer = join();
  const auto bus = join({.open_timeout = no_wait});
  ASSERT_EQ(peer->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*bus, 1)), std::vector{numbered(1)});
}

}  // namespace
}  // namespace roio::test
