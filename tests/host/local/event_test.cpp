// Events that only a local bus has: of programs that carry it, are stopped, end, or run another
// rate. That no call waits is proved by a carrier that is stopped: it would be waited for for ever.
#include <csignal>
#include <roio.hpp>
#include <string>
#include <vector>

#include "event_loop.hpp"
#include "process.hpp"

namespace roio::test {
namespace {

using namespace std::chrono_literals;

Frame some_frame(std::uint8_t byte = 0) {
  return {0x1004A00A, FrameKind::extended, 1, {byte}};
}

/// What open() throws.
std::string refusal(const std::string& url) {
  try {
    const auto bus = open(url, {.open_timeout = no_wait});
  } catch (const std::system_error& error) {
    return error.what();
  }
  return "(opened)";
}

/// Sleeps until the state is this, told by events.
void await_state(Bus& bus, BusState state) {
  while (bus.state() != state && !testing::Test::HasFailure()) {
    EXPECT_TRUE(next_events(bus).state) << to_string(bus.state());
  }
}

class LocalEvents : public testing::Test {
 protected:
  const std::string url_ = "local:" + unique_name();
};

TEST_F(LocalEvents, AStoppedCarrierIsToldWhileFramesWaitForIt) {
  Peer carrier({"hold", url_});
  ASSERT_EQ(carrier.line(), "open");
  const auto bus = open(url_, {.carry = Carry::never});
  ASSERT_EQ(bus->send(some_frame(), 30s), Result::ok);
  expect_no_events(*bus);

  carrier.stop();
  ASSERT_EQ(bus->send(some_frame(), no_wait), Result::ok);
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->state(), BusState::down);
  ASSERT_TRUE(bus->trouble());
  EXPECT_EQ(bus->trouble()->code(), Errc::carrier_stopped) << bus->trouble()->what();

  carrier.signal(SIGCONT);
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_FALSE(bus->trouble());
  expect_no_events(*bus);
}

TEST_F(LocalEvents, NoCallWaitsForAStoppedCarrier) {
  Peer carrier({"hold", url_});
  ASSERT_EQ(carrier.line(), "open");
  const auto bus = open(url_, {.carry = Carry::never});
  carrier.stop();

  const std::vector<Frame> many(10'000, some_frame());
  const Transfer transfer = bus->send(many, no_wait);
  EXPECT_EQ(transfer.result, Result::timeout);
  EXPECT_GT(transfer.count, 0U);
  Received received{};
  EXPECT_EQ(bus->receive(received, no_wait), Result::timeout);
  bus->begin_set_filters({});
  EXPECT_TRUE(next_events(*bus).filters);
  const auto late =
      open(url_, {.open_timeout = forever, .background = true, .carry = Carry::never});
  EXPECT_EQ(late->state(), BusState::absent);
  late->begin_close();
  await_state(*bus, BusState::down);

  carrier.signal(SIGCONT);
  Events events;
  while (!events.room && !HasFailure()) {
    events = next_events(*bus);
  }
  EXPECT_GT(bus->send(many, no_wait).count, 0U) << "there is room";

  carrier.stop();
  static_cast<void>(bus->send(many, no_wait));  // whatever of the others it has had
  bus->begin_close();
  EXPECT_EQ(bus->send(some_frame(), forever), Result::closed);
  while (!next_events(*bus).closed && !HasFailure()) {
  }
  EXPECT_GT(bus->statistics().unsent, 0U) << "the carrier stood still for the second that it takes";
}

TEST_F(LocalEvents, LossAtCloseIsTold) {
  Peer carrier({"hold", url_});
  ASSERT_EQ(carrier.line(), "open");
  const auto bus = open(url_, {.carry = Carry::never});
  carrier.stop();
  ASSERT_EQ(bus->send(some_frame(), no_wait), Result::ok);
  bus->close();
  const Events events = bus->take_events();
  EXPECT_TRUE(events.loss);
  EXPECT_TRUE(events.closed);
  EXPECT_EQ(bus->statistics().unsent, 1U);
}

TEST_F(LocalEvents, TheEndOfACarrierAndItsSuccessorAreTold) {
  Peer carrier({"hold", url_});
  ASSERT_EQ(carrier.line(), "open");
  const auto bus = open(url_, {.carry = Carry::never});
  carrier.kill();
  await_state(*bus, BusState::absent);
  EXPECT_EQ(bus->send(some_frame(), no_wait), Result::timeout);
  Peer next({"hold", url_});
  ASSERT_EQ(next.line(), "open");
  Events events;
  while (!events.room && !HasFailure()) {
    events = next_events(*bus);
  }
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(bus->send(some_frame(), no_wait), Result::ok);
}

// A bus that nobody carries has no room: asking again and again would be a loop that spins.
TEST_F(LocalEvents, NoRoomIsToldWhileNobodyCarriesIt) {
  const auto bus = open(url_, {.open_timeout = no_wait, .background = true, .carry = Carry::never});
  ASSERT_EQ(bus->send(some_frame(), no_wait), Result::timeout);
  do {
    EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  } while (!bus->trouble() && !HasFailure());
  EXPECT_EQ(bus->trouble()->code(), Errc::not_connected);
  for (int i = 0; i < 20; ++i) {  // over several of its looks for a carrier
    expect_no_events(*bus);
  }
}

TEST_F(LocalEvents, AnotherBitRateIsToldAndTheBusIsLookedForOn) {
  auto other = open(url_ + "?bitrate=125000");
  const auto bus = open(url_ + "?bitrate=500000", {.background = true});
  while (!bus->trouble() && !HasFailure()) {
    EXPECT_TRUE(next_events(*bus).state);
  }
  EXPECT_EQ(bus->trouble()->code(), Errc::bitrate_mismatch);
  EXPECT_EQ(bus->trouble()->what(), refusal(url_ + "?bitrate=500000"))
      << "the same that open() throws";
  EXPECT_EQ(bus->state(), BusState::absent);
  other.reset();
  await_state(*bus, BusState::active);
  EXPECT_FALSE(bus->trouble());
}

TEST_F(LocalEvents, OpenWithoutWaitingTakesABusThatIsThere) {
  Peer carrier({"hold", url_});
  ASSERT_EQ(carrier.line(), "open");
  EXPECT_EQ(open(url_, {.open_timeout = no_wait, .carry = Carry::never})->state(),
            BusState::active);
  EXPECT_EQ(open(url_, {.open_timeout = no_wait})->state(), BusState::active);
}

TEST_F(LocalEvents, WhatNoWaitingMendsIsThrownAtOnce) {
  EXPECT_THROW(open("local:", {.background = true}), std::system_error);
  EXPECT_THROW(open("nonsense:", {.background = true}), std::system_error);
}

}  // namespace
}  // namespace roio::test
