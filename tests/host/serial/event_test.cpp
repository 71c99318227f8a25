// Events and requests of a bridge, for programs that may not wait. That no call waits is proved by
// a bridge that is deaf: it would be waited for for ever, or to the call's own end.
#include <gtest/gtest.h>

#include <algorithm>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <string>
#include <vector>

#include "event_loop.hpp"
#include "pty_bridge.hpp"

namespace roio::test {
namespace {

/// The next reply, told by an event.
BridgeReply next_reply(Bus& bus) {
  Bridge& bridge = *bridge_of(bus);
  for (;;) {
    if (auto reply = bridge.take_reply()) {
      return *reply;
    }
    if (testing::Test::HasFailure()) {
      return {};
    }
    next_events(bus);
  }
}

std::error_code code_of(const BridgeReply& reply) {
  return reply.error ? reply.error->code() : std::error_code();
}

void set_deaf(PtyBridge& bridge, bool is_deaf) {
  bridge.with([is_deaf](ScriptedBridge& one) { one.is_deaf = is_deaf; });
}

TEST(BridgeRequests, AreAnsweredByTheirNumbers) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  Bridge& bridge = *bridge_of(*bus);
  EXPECT_FALSE(bridge.take_reply());
  const std::vector<std::uint32_t> begun{
      bridge.begin_set_bus(250'000, BridgeMode::listen), bridge.begin_set_address(Address{0, 7}),
      bridge.begin_identify(std::chrono::seconds(3)), bridge.begin_counters()};
  std::vector<std::uint32_t> answered;
  for (std::size_t i = 0; i < begun.size(); ++i) {
    const BridgeReply reply = next_reply(*bus);
    EXPECT_EQ(code_of(reply), std::error_code()) << reply.error->what();
    EXPECT_EQ(reply.counters.has_value(), reply.id == begun.back());
    answered.push_back(reply.id);
  }
  std::sort(answered.begin(), answered.end());
  EXPECT_EQ(answered, begun) << "each once";
  EXPECT_EQ(bridge.info().bitrate_bps, 250'000U);
  EXPECT_EQ(bridge.info().address, (Address{0, 7}));
  EXPECT_FALSE(bridge.take_reply());
}

TEST(BridgeRequests, ARefusalIsWhatTheWaitingFormThrows) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  pty.with([](ScriptedBridge& one) {
    one.verdict = [](serial::Down operation) -> std::uint8_t {
      return operation == serial::Down::bus ? 8 : 0;
    };
  });
  Bridge& bridge = *bridge_of(*bus);
  bridge.begin_set_bus(800'000, BridgeMode::normal);
  const BridgeReply reply = next_reply(*bus);
  EXPECT_EQ(code_of(reply), Errc::bridge_refused);
  try {
    bridge.set_bus(800'000, BridgeMode::normal);
    FAIL() << "it was accepted";
  } catch (const std::system_error& error) {
    EXPECT_STREQ(reply.error->what(), error.what());
  }
}

TEST(BridgeRequests, OfADeafBridgeEndToo) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  set_deaf(pty, true);
  Bridge& bridge = *bridge_of(*bus);
  const std::uint32_t counters = bridge.begin_counters();
  const std::uint32_t address = bridge.begin_set_address(std::nullopt);
  std::vector<std::uint32_t> answered{next_reply(*bus).id, next_reply(*bus).id};
  std::sort(answered.begin(), answered.end());
  EXPECT_EQ(answered, (std::vector{counters, address}));
}

TEST(BridgeRequests, UnderWayAtTheCloseAreAnsweredByIt) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  set_deaf(pty, true);
  Bridge& bridge = *bridge_of(*bus);
  bridge.begin_counters();
  bridge.begin_identify(std::chrono::seconds(1));
  bus->close();
  for (int i = 0; i < 2; ++i) {
    const auto reply = bridge.take_reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(code_of(*reply), Errc::no_bridge);
  }
  bridge.begin_counters();
  EXPECT_EQ(code_of(next_reply(*bus)), Errc::no_bridge) << "and after it";
}

TEST(BridgeRequests, HaveALimit) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  Bridge& bridge = *bridge_of(*bus);
  for (int i = 0; i < 64; ++i) {
    bridge.begin_identify(std::chrono::seconds(0));
  }
  try {
    bridge.begin_counters();
    FAIL() << "a 65th was accepted";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_buffer_space);
  }
  next_reply(*bus);
  EXPECT_NO_THROW(bridge.begin_counters());
}

TEST(SerialEvents, ADeafBridgeIsWaitedForByNoCall) {
  PtyBridge pty(false);
  const auto bus = open("serial:" + pty.path(), {.open_timeout = forever, .background = true});
  EXPECT_EQ(bus->state(), BusState::absent);
  EXPECT_EQ(bus->send(Frame{1, FrameKind::extended, 0, {}}, no_wait), Result::timeout);
  bus->begin_set_filters({});
  EXPECT_TRUE(next_events(*bus).filters) << "they will hold when it is there";
  set_deaf(pty, false);
  Events events;
  while (!events.room && !testing::Test::HasFailure()) {
    events = next_events(*bus);
  }
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_TRUE(pty.with([](ScriptedBridge& one) { return one.rules.empty(); })) << "and do";
  EXPECT_EQ(bus->send(Frame{1, FrameKind::extended, 0, {}}, no_wait), Result::ok);
}

TEST(SerialEvents, WhatIsWrongWithABridgeIsToldAndItIsLookedForOn) {
  PtyBridge pty(false);
  const auto bus = open("serial:" + pty.path(), {.open_timeout = no_wait, .background = true});
  while (!bus->trouble() && !testing::Test::HasFailure()) {
    EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  }
  EXPECT_EQ(bus->trouble()->code(), Errc::no_bridge);
  pty.with([](ScriptedBridge& one) {
    one.version = 1;
    one.is_deaf = false;
  });
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->trouble()->code(), Errc::version_mismatch);
  pty.with([](ScriptedBridge& one) { one.version = serial::protocol_version; });
  while (bus->state() != BusState::active && !testing::Test::HasFailure()) {
    next_events(*bus);
  }
  EXPECT_FALSE(bus->trouble());
}

TEST(SerialEvents, APortThatIsNotThereIsNoErrorInTheBackground) {
  const auto bus = open("serial:/dev/nosuchtty", {.background = true});
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->trouble()->code(), Errc::no_such_port);
  bus->begin_close();
  EXPECT_TRUE(next_events(*bus).closed);
}

TEST(SerialEvents, UnpluggingIsTold) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  expect_no_events(*bus);
  pty.unplug();
  while (bus->state() != BusState::absent && !testing::Test::HasFailure()) {
    EXPECT_TRUE(next_events(*bus).state);
  }
}

TEST(SerialEvents, LossesOnTheLineAreTold) {
  PtyBridge pty;
  const auto bus = open("serial:" + pty.path());
  pty.with([](ScriptedBridge& one) {
    one.hear(Frame{2, FrameKind::extended, 0, {}}, std::chrono::seconds(0), false);
  });
  EXPECT_EQ(next_events(*bus), (Events{.loss = true}));
  EXPECT_EQ(bus->statistics().dropped, 1U);
}

TEST(SerialEvents, OpenWithAZeroTimeoutTakesABridgeThatIsThere) {
  PtyBridge pty;
  EXPECT_EQ(open("serial:" + pty.path(), {.open_timeout = no_wait})->state(), BusState::active);
}

}  // namespace
}  // namespace roio::test
