// Opening a bus over a pseudo terminal, what can be wrong with that, and looking for the bridge.
#include <gtest/gtest.h>
#include <stdlib.h>
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

// Something was said to a bridge that does not answer.
bool was_called(PtyBridge& silent) {
  return silent.with([](ScriptedBridge& one) { return one.unheard > 0; });
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
    EXPECT_TRUE(becomes([&] { return was_called(bridge); }));
    bridge.with([](ScriptedBridge& one) { one.is_deaf = false; });
  });
  EXPECT_NO_THROW(open("serial:" + bridge.path(), {.open_timeout = guard}));
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
  const OpenOptions patient{.open_timeout = guard};
};

// A terminal that nobody answers at. It goes when it was called, so that nobody waits for its
// answer as long as for that of those who answer late.
class SilentPort {
 public:
  SilentPort() = default;
  SilentPort(const SilentPort&) = delete;
  SilentPort& operator=(const SilentPort&) = delete;
  ~SilentPort() { leaver_.join(); }
  [[nodiscard]] const std::string& path() const { return bridge_.path(); }

 private:
  PtyBridge bridge_{false};
  std::thread leaver_{[this] {
    EXPECT_TRUE(becomes([this] { return was_called(bridge_); }));
    bridge_.unplug();
  }};
};

TEST_F(SerialAuto, OpensTheOneBridge) {
  PtyBridge bridge;
  const SilentPort silent;
  among({silent.path(), bridge.path()});
  const auto bus = open("serial:auto", patient);
  EXPECT_EQ(bus->name(), "serial:auto");
  EXPECT_EQ(bridge_of(*bus)->info().port, bridge.path());
}

TEST_F(SerialAuto, LeavesWhatItAsksAsItWas) {
  PtyBridge bridge;
  bridge.with([](ScriptedBridge& one) { one.rules = {{5, 7}}; });
  among({bridge.path()});
  const auto found = find_bridges(guard);
  ASSERT_EQ(found.size(), 1U);
  ASSERT_TRUE(found[0].bridge) << found[0].why_not;
  EXPECT_EQ(found[0].bridge->port, bridge.path());
  EXPECT_EQ(found[0].bridge->bitrate_bps, 500'000U);
  EXPECT_EQ(found[0].bridge->state, BridgeState::active);
  EXPECT_EQ(found[0].why_not, "");
  const auto session = [&] { return bridge.with([](auto& one) { return one.session(); }); };
  EXPECT_TRUE(becomes([&] { return session() == 0U; })) << "BYE was said";
  bridge.with([](ScriptedBridge& one) {
    EXPECT_EQ(one.count_of(serial::Down::bus), 0);
    EXPECT_EQ(one.count_of(serial::Down::speed), 0);
    ASSERT_EQ(one.rules.size(), 1U);
    EXPECT_EQ(one.rules[0].match, 5U);
  });
}

TEST_F(SerialAuto, FailsWithoutAPort) {
  const Failure failure = failure_of("serial:auto", patient);
  EXPECT_EQ(failure.code, Errc::no_bridge);
  EXPECT_EQ(failure.what.substr(0, failure.what.rfind(": ")),
            "serial:auto: no port of a likely board");
}

TEST_F(SerialAuto, FailsAndSaysWhatItSaw) {
  const SilentPort silent;
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
  const Failure failure = failure_of("serial:auto", patient);
  EXPECT_EQ(failure.code, Errc::no_bridge);
  EXPECT_EQ(failure.what.substr(0, text.size() + 1), text + ")");
  EXPECT_EQ(other->state(), BusState::active) << "it was not disturbed";
}

TEST_F(SerialAuto, WaitsForAnAnswerNoLongerThanItMay) {
  PtyBridge silent(false);
  among({silent.path()});
  const auto start = std::chrono::steady_clock::now();
  const Failure failure = failure_of("serial:auto", {.open_timeout = 300ms});
  EXPECT_GE(std::chrono::steady_clock::now() - start, 300ms);
  EXPECT_EQ(failure.code, Errc::no_bridge);
}

TEST_F(SerialAuto, FailsWithSeveralBridges) {
  PtyBridge one;
  PtyBridge other;
  among({one.path(), other.path()});
  const Failure failure = failure_of("serial:auto", patient);
  EXPECT_EQ(failure.code, Errc::several_bridges);
  EXPECT_NE(failure.what.find(one.path() + ": a bridge"), std::string::npos) << failure.what;
  EXPECT_NE(failure.what.find(other.path() + ": a bridge"), std::string::npos) << failure.what;
}

TEST_F(SerialAuto, TakesPatterns) {
  PtyBridge bridge;
  const std::string link = "/tmp/roio-auto-" + std::to_string(::getpid());
  std::filesystem::create_symlink(bridge.path(), link);
  among({"/tmp/nothing-like-this-*", link.substr(0, link.size() - 1) + "?"});
  const auto found = find_bridges(guard);
  std::filesystem::remove(link);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, link);
  EXPECT_TRUE(found[0].bridge);
}

}  // namespace
}  // namespace roio::test
