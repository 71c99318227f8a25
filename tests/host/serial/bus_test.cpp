// The bus over a pseudo terminal: opening, what can be wrong with that, unplugging, and the rest of
// what tests/host/contract does not ask of every bus.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <system_error>

#include "pty_bridge.hpp"
#include "serial/down.hpp"

namespace roio::test {
namespace {

constexpr std::chrono::seconds guard{20};

Frame frame_of(std::uint32_t id, std::uint8_t byte = 0) {
  return {id, FrameKind::extended, 1, {byte}};
}

struct Failure {
  std::error_code code;
  std::string what;
};

Failure failure_of(const std::string& url, const OpenOptions& options = {}) {
  try {
    const auto bus = open(url, options);
    ADD_FAILURE() << url << " was opened";
    return {};
  } catch (const std::system_error& error) {
    return {error.code(), error.what()};
  }
}

bool becomes(const std::function<bool()>& it_is_so, std::chrono::milliseconds patience = 5s) {
  for (const auto end = std::chrono::steady_clock::now() + patience;
       std::chrono::steady_clock::now() < end && !it_is_so();) {
    std::this_thread::sleep_for(1ms);
  }
  return it_is_so();
}

// --- opening -------------------------------------------------------------------------------------

TEST(SerialOpen, GivesABridge) {
  PtyBridge bridge;
  const std::string url = "serial:" + bridge.path();
  const auto bus = open(url + "?baud=500000&bitrate=125000&mode=listen");
  EXPECT_EQ(bus->name(), url);
  EXPECT_EQ(bus->state(), BusState::active);
  Bridge* const behind = bridge_of(*bus);
  ASSERT_NE(behind, nullptr);
  const BridgeInfo info = behind->info();
  EXPECT_EQ(info.port, bridge.path());
  EXPECT_EQ(info.line_rate_bps, 500'000U);
  EXPECT_EQ(info.bitrate_bps, 125'000U);
  EXPECT_EQ(info.mode, BridgeMode::listen);
  EXPECT_EQ(bridge.with([](ScriptedBridge& one) { return one.bitrate_bps; }), 125'000U);
  EXPECT_EQ(behind->counters().overruns, 110U);
  EXPECT_EQ(behind->line_counters().sessions, 1U);
}

TEST(SerialOpen, OnlyABridgeHasOne) {
  const auto bus = open("local:serial-test-" + std::to_string(::getpid()));
  EXPECT_EQ(bridge_of(*bus), nullptr);
}

TEST(SerialOpen, FailsWithoutAPort) {
  const Failure failure = failure_of("serial:/dev/nosuchtty");
  EXPECT_EQ(failure.code, Errc::no_such_port);
  EXPECT_EQ(failure.what,
            "serial:/dev/nosuchtty: no such serial port; `ls /dev/ttyACM* /dev/ttyUSB*` lists "
            "those that are plugged in, and serial:auto finds a bridge among them");
}

TEST(SerialOpen, FailsWithWhatIsNoPort) {
  for (const char* const path : {"/dev/null", "/tmp"}) {
    const Failure failure = failure_of(std::string("serial:") + path);
    EXPECT_EQ(failure.code, Errc::not_a_port) << failure.what;
  }
}

TEST(SerialOpen, FailsWhileAnotherHasThePort) {
  PtyBridge bridge;
  const std::string url = "serial:" + bridge.path();
  {
    const auto bus = open(url);
    const Failure failure = failure_of(url);
    EXPECT_EQ(failure.code, Errc::port_in_use);
    EXPECT_EQ(failure.what, url +
                                ": another program has the port open; `fuser -v` with the port's "
                                "name tells which");
    EXPECT_EQ(bus->state(), BusState::active) << "which does not mind";
  }
  EXPECT_NO_THROW(open(url)) << "and not after it";
}

TEST(SerialOpen, FailsWhenNobodyAnswersInTime) {
  PtyBridge silent(false);
  const auto start = std::chrono::steady_clock::now();
  const Failure failure = failure_of("serial:" + silent.path(), {.open_timeout = 300ms});
  EXPECT_GE(std::chrono::steady_clock::now() - start, 300ms);
  EXPECT_EQ(failure.code, Errc::no_bridge);
  EXPECT_EQ(failure.what, "serial:" + silent.path() +
                              ": no bridge answered in time; is the board plugged in, and "
                              "bridge_usb on it? `scripts/flash` puts it there");
}

TEST(SerialOpen, FailsWithAnotherVersionAndSaysWhatToDo) {
  PtyBridge bridge;
  bridge.with([](ScriptedBridge& one) { one.version = 1; });
  const Failure failure = failure_of("serial:" + bridge.path());
  EXPECT_EQ(failure.code, Errc::version_mismatch);
  EXPECT_EQ(failure.what.substr(0, failure.what.rfind(": ")),
            "serial:" + bridge.path() +
                ": a bridge of protocol version 1 (firmware 0.1.0), and this is version 2; "
                "`scripts/flash` puts the matching firmware on the board");
}

TEST(SerialOpen, FailsWhenTheBridgeRefusesTheBitRate) {
  PtyBridge bridge;
  bridge.with([](ScriptedBridge& one) {
    one.verdict = [](serial::Down operation) -> std::uint8_t {
      return operation == serial::Down::bus ? 8 : 0;
    };
  });
  const Failure failure = failure_of("serial:" + bridge.path() + "?bitrate=800000");
  EXPECT_EQ(failure.code, Errc::bridge_refused);
  EXPECT_EQ(failure.what,
            "serial:" + bridge.path() +
                ": the controller cannot make this bit rate from its crystal: the bridge refused");
}

TEST(SerialOpen, WaitsForABoardThatIsJustStarting) {
  PtyBridge bridge(false);
  std::thread starter([&bridge] {
    std::this_thread::sleep_for(400ms);
    bridge.with([](ScriptedBridge& one) { one.is_deaf = false; });
  });
  EXPECT_NO_THROW(open("serial:" + bridge.path()));
  starter.join();
}

// --- serial:auto ---------------------------------------------------------------------------------

class SerialAuto : public testing::Test {
 protected:
  SerialAuto() { among({}); }
  ~SerialAuto() override { ::unsetenv("ROIO_SERIAL_PORTS"); }
  static void among(const std::vector<std::string>& paths) {
    std::string list;
    for (const std::string& path : paths) {
      list += path + ':';
    }
    ::setenv("ROIO_SERIAL_PORTS", list.c_str(), 1);
  }
  const OpenOptions quick{.open_timeout = 500ms};
};

TEST_F(SerialAuto, OpensTheOneBridge) {
  PtyBridge bridge;
  PtyBridge silent(false);
  among({silent.path(), bridge.path()});
  const auto bus = open("serial:auto", {.open_timeout = 1s});
  EXPECT_EQ(bus->name(), "serial:auto");
  EXPECT_EQ(bridge_of(*bus)->info().port, bridge.path());
}

TEST_F(SerialAuto, LeavesWhatItAsksAsItWas) {
  PtyBridge bridge;
  bridge.with([](ScriptedBridge& one) { one.rules = {{5, 7}}; });
  among({bridge.path()});
  const auto found = find_bridges(1s);
  ASSERT_EQ(found.size(), 1U);
  ASSERT_TRUE(found[0].bridge) << found[0].why_not;
  EXPECT_EQ(found[0].bridge->port, bridge.path());
  EXPECT_EQ(found[0].bridge->bitrate_bps, 500'000U);
  EXPECT_EQ(found[0].bridge->state, BridgeState::active);
  EXPECT_EQ(found[0].why_not, "");
  bridge.with([](ScriptedBridge& one) {
    EXPECT_EQ(one.session(), 0U) << "BYE was said";
    EXPECT_EQ(one.count_of(serial::Down::bus), 0);
    EXPECT_EQ(one.count_of(serial::Down::speed), 0);
    ASSERT_EQ(one.rules.size(), 1U);
    EXPECT_EQ(one.rules[0].match, 5U);
  });
}

TEST_F(SerialAuto, FailsWithoutAPort) {
  const Failure failure = failure_of("serial:auto", quick);
  EXPECT_EQ(failure.code, Errc::no_bridge);
  EXPECT_EQ(failure.what.substr(0, failure.what.rfind(": ")),
            "serial:auto: no port of a likely board");
}

TEST_F(SerialAuto, FailsAndSaysWhatItSaw) {
  PtyBridge silent(false);
  PtyBridge old;
  PtyBridge busy;
  old.with([](ScriptedBridge& one) { one.version = 9; });
  const auto other = open("serial:" + busy.path());
  among({silent.path(), old.path(), busy.path(), "/dev/null"});
  std::vector<std::pair<std::string, std::string>> expected{
      {silent.path(), "no bridge answered"},
      {old.path(), "a bridge of protocol version 9 (firmware 0.1.0)"},
      {busy.path(), "another program has it open"},
      {"/dev/null", "not a serial port; expected one such as /dev/ttyACM0"}};
  std::sort(expected.begin(), expected.end());
  std::string text = "serial:auto (";
  for (const auto& [path, why] : expected) {
    text += (text.back() == '(' ? "" : ", ") + path + ": " + why;
  }
  const Failure failure = failure_of("serial:auto", quick);
  EXPECT_EQ(failure.code, Errc::no_bridge);
  EXPECT_EQ(failure.what.substr(0, text.size() + 1), text + ")");
  EXPECT_EQ(other->state(), BusState::active) << "it was not disturbed";
}

TEST_F(SerialAuto, FailsWithSeveralBridges) {
  PtyBridge one;
  PtyBridge other;
  among({one.path(), other.path()});
  const Failure failure = failure_of("serial:auto", quick);
  EXPECT_EQ(failure.code, Errc::several_bridges);
  EXPECT_NE(failure.what.find(one.path() + ": a bridge"), std::string::npos) << failure.what;
  EXPECT_NE(failure.what.find(other.path() + ": a bridge"), std::string::npos) << failure.what;
}

TEST_F(SerialAuto, TakesPatterns) {
  PtyBridge bridge;
  const std::string link = "/tmp/roio-auto-" + std::to_string(::getpid());
  std::filesystem::create_symlink(bridge.path(), link);
  among({"/tmp/nothing-like-this-*", link.substr(0, link.size() - 1) + "?"});
  const auto found = find_bridges(1s);
  std::filesystem::remove(link);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, link);
  EXPECT_TRUE(found[0].bridge);
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
  EXPECT_LT(std::chrono::steady_clock::now() - start, 2s);
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
  EXPECT_LT(std::chrono::steady_clock::now() - start, 2s);
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
    EXPECT_EQ(one.heard.back().back(), 5);
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
