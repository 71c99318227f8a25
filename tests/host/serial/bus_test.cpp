// The bus over a pseudo terminal: unplugging, and the rest of what tests/host/contract does not ask
// of every bus.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <system_error>

#include "patience.hpp"
#include "pty_bridge.hpp"
#include "serial/down.hpp"

namespace roio::test {
namespace {

Frame frame_of(std::uint32_t id, std::uint8_t byte = 0) {
  return {id, FrameKind::extended, 1, {byte}};
}

// --- the bus -------------------------------------------------------------------------------------

TEST(SerialBus, FiltersThatFitAreTheBridges) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  const auto rules = [&] { return bridge.with([](ScriptedBridge& one) { return one.rules; }); };
  bus->set_filters(std::array{SocketCanFilter{0x123, 0x800007FF}});
  ASSERT_EQ(rules().size(), 1U);
  EXPECT_EQ(rules()[0].match, 0x123U);
  EXPECT_EQ(rules()[0].mask, 0x800007FFU);
  bus->set_filters(std::array{SocketCanFilter{0xFFFFFFFF & ~socketcan::inverted, 0x3FFFFFFF}});
  ASSERT_EQ(rules().size(), 1U);
  EXPECT_EQ(rules()[0].match, 0x1FFFFFFFU);
  EXPECT_EQ(rules()[0].mask, 0x1FFFFFFFU) << "without the kernel's own bit";
  bus->set_filters(std::vector(6, SocketCanFilter{1, 3}));
  EXPECT_EQ(rules().size(), 6U);
  bus->set_filters({});
  EXPECT_TRUE(rules().empty());
}

TEST(SerialBus, OtherFiltersAreThePcs) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  for (const auto& filters : {std::vector{SocketCanFilter{socketcan::inverted | 5, 0xFF}},
                              std::vector(7, SocketCanFilter{6, 0xFF})}) {
    bus->set_filters(filters);
    ASSERT_EQ(bridge.with([](ScriptedBridge& one) { return one.rules.at(0).mask; }), 0U);
    bridge.hear(frame_of(5));
    bridge.hear(frame_of(6));
    Received received{};
    ASSERT_EQ(bus->receive(received, guard), Result::ok);
    EXPECT_EQ(received.frame.id, 6U);
    EXPECT_EQ(received.lost_before, 0U);
  }
}

TEST(SerialBus, LossesAreToldAndCounted) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  bridge.hear(frame_of(1));
  bridge.with([](ScriptedBridge& one) {
    for (int i = 0; i < 300; ++i) {
      one.hear(frame_of(2), 0s, false);
    }
  });
  ASSERT_TRUE(becomes([&] { return bus->statistics().dropped == 300; })) << "STATUS tells";
  bridge.hear(frame_of(3));
  Received received{};
  ASSERT_EQ(bus->receive(received, guard), Result::ok);
  EXPECT_EQ(received.lost_before, 0U);
  ASSERT_EQ(bus->receive(received, guard), Result::ok);
  EXPECT_EQ(received.frame.id, 3U);
  EXPECT_EQ(received.lost_before, 300U);
}

TEST(SerialBus, ComesBackAfterItWasUnplugged) {
  PtyBridge bridge;
  const std::string link = "/tmp/roio-replug-" + std::to_string(::getpid());
  const auto lead = [&] { std::filesystem::create_symlink(bridge.path(), link); };
  lead();
  const auto bus = open("serial:" + link);
  bridge.unplug();
  std::filesystem::remove(link);
  ASSERT_TRUE(becomes([&] { return bus->state() == BusState::absent; }));
  EXPECT_EQ(bus->statistics().outages, 1U);
  EXPECT_EQ(bus->send(frame_of(7), 50ms), Result::timeout) << "it waits for the bridge";
  EXPECT_EQ(bridge_of(*bus)->info().state, BridgeState::absent);
  bridge.hear(frame_of(1));  // due, and lost
  bridge.plug();
  lead();
  ASSERT_TRUE(becomes([&] { return bus->state() == BusState::active; }));
  EXPECT_EQ(bus->send(frame_of(8), guard), Result::ok);
  bridge.hear(frame_of(2));
  Received received{};
  ASSERT_EQ(bus->receive(received, guard), Result::ok);
  EXPECT_EQ(received.frame.id, 2U);
  EXPECT_EQ(received.lost_before, 1U);
  EXPECT_EQ(bus->statistics().outages, 1U);
  EXPECT_EQ(bridge_of(*bus)->line_counters().sessions, 2U);
  std::filesystem::remove(link);
}

TEST(SerialBus, ReportsTheControllersStateAsSocketCanDoes) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path(), {.error_frames = true});
  bridge.with([](ScriptedBridge& one) { one.state = 2; });
  Received received{};
  ASSERT_EQ(bus->receive(received, guard), Result::ok);
  EXPECT_EQ(received.frame.kind, FrameKind::error);
  EXPECT_EQ(received.frame.id, 0x204U) << "CAN_ERR_CRTL, CAN_ERR_CNT";
  EXPECT_EQ(received.frame.data[1], 0x10) << "receive passive: the counters are below by now";
  EXPECT_EQ(received.frame.data[6], 5);
  EXPECT_EQ(received.frame.data[7], 7);
  EXPECT_EQ(bus->state(), BusState::passive);
  EXPECT_EQ(bus->statistics().error_frames, 1U);
  EXPECT_EQ(bus->statistics().received, 0U);
}

TEST(SerialBus, IsDownWithoutAController) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  bridge.with([](ScriptedBridge& one) { one.state = 4; });
  ASSERT_TRUE(becomes([&] { return bus->state() == BusState::down; }));
  EXPECT_EQ(bridge_of(*bus)->info().state, BridgeState::no_controller);
  EXPECT_EQ(bus->statistics().outages, 0U);
}

TEST(SerialBus, SaysByeAndCountsWhatItCouldNotHandOver) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  bridge.with([](ScriptedBridge& one) { one.bus_is_free = false; });
  const std::vector<Frame> frames(40, frame_of(1));
  ASSERT_EQ(bus->send(frames, guard).count, 40U);
  const auto start = std::chrono::steady_clock::now();
  bus->close();
  EXPECT_LT(std::chrono::steady_clock::now() - start, guard);
  EXPECT_EQ(bus->statistics().unsent, 40U);
  EXPECT_EQ(bridge.with([](ScriptedBridge& one) { return one.session(); }), 0U);
}

TEST(SerialBus, ClosesWithoutItsBridge) {
  auto bridge = std::make_unique<PtyBridge>();
  const auto bus = open("serial:" + bridge->path());
  bridge.reset();
  ASSERT_TRUE(becomes([&] { return bus->state() == BusState::absent; }));
  const auto start = std::chrono::steady_clock::now();
  bus->close();
  EXPECT_LT(std::chrono::steady_clock::now() - start, guard);
}

// --- the bridge ----------------------------------------------------------------------------------

TEST(SerialBridge, IsSet) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  Bridge& behind = *bridge_of(*bus);
  behind.set_bus(250'000, BridgeMode::loopback);
  EXPECT_EQ(behind.info().bitrate_bps, 250'000U);
  EXPECT_EQ(behind.info().mode, BridgeMode::loopback);
  behind.set_address(Address{3, 200});
  EXPECT_EQ(behind.info().address->node, 200);
  behind.set_address(std::nullopt);
  EXPECT_FALSE(behind.info().address);
  behind.identify(5s);
  bridge.with([](ScriptedBridge& one) {
    EXPECT_EQ(one.bitrate_bps, 250'000U);
    EXPECT_EQ(one.mode, 2);
    // Not the last of all: questions for counters come in between.
    const auto last = std::find_if(one.heard.rbegin(), one.heard.rend(), [](const Bytes& body) {
      return body[0] == static_cast<std::uint8_t>(serial::Down::identify);
    });
    ASSERT_NE(last, one.heard.rend());
    EXPECT_EQ(last->back(), 5);
  });
}

TEST(SerialBridge, SaysWhyItIsNotSet) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  bridge.with(
      [](ScriptedBridge& one) { one.verdict = [](serial::Down) -> std::uint8_t { return 8; }; });
  try {
    bridge_of(*bus)->set_bus(83'333, BridgeMode::normal);
    ADD_FAILURE() << "it was set";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), Errc::bridge_refused);
    EXPECT_EQ(std::string(error.what()),
              bus->name() +
                  ": bit rate 83333, mode normal: the controller cannot make this bit "
                  "rate from its crystal: the bridge refused");
  }
}

TEST(SerialBridge, ThatIsGoneAnswersNothing) {
  PtyBridge bridge;
  const auto bus = open("serial:" + bridge.path());
  bridge.unplug();
  ASSERT_TRUE(becomes([&] { return bus->state() == BusState::absent; }));
  const auto is_no_bridge = [](const std::function<void()>& call) {
    try {
      call();
    } catch (const std::system_error& error) {
      return error.code() == Errc::no_bridge;
    }
    return false;
  };
  Bridge& behind = *bridge_of(*bus);
  EXPECT_TRUE(is_no_bridge([&] { behind.identify(5s); }));
  EXPECT_TRUE(is_no_bridge([&] { static_cast<void>(behind.counters(50ms)); }));
  EXPECT_EQ(behind.info().firmware.minor, 1) << "as last known";
}

}  // namespace
}  // namespace roio::test
