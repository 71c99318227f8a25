// The hub's rules that no other bus has: bit rates that must agree, who may use it, what is cleaned
// up, and pacing by exact frame length.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <roio.hpp>
#include <thread>

#include "local/connection.hpp"
#include "local/memory.hpp"
#include "local/place.hpp"
#include "process.hpp"
#include "rig.hpp"

namespace roio {
namespace {

using namespace std::chrono_literals;
using test::becomes;
using test::Peer;
using test::refusal;
using test::unique_name;

TEST(LocalBus, WhoOnlyJoinsCarriesItForNobody) {
  const std::string name = "local:" + unique_name();
  const OpenOptions joining{.open_timeout = 50ms, .carry = Carry::never};
  try {
    const auto bus = open(name, joining);
    ADD_FAILURE() << "it opened though nobody carries the bus";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(Errc::not_connected)) << error.what();
  }
  auto carrier = open(name);
  const auto joined = open(name, {.open_timeout = 30s, .carry = Carry::never});
  EXPECT_TRUE(becomes(*carrier, 1));
  carrier.reset();
  for (int tries = 0; tries < 30000 && joined->state() != BusState::absent; ++tries) {
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(joined->state(), BusState::absent) << "it has not taken the bus over";
  const auto next = open(name);
  EXPECT_TRUE(becomes(*next, 1)) << "it has come to the next one";
  ASSERT_EQ(joined->send(Frame{0x1000400A, FrameKind::extended, 0, {}}, 30s), Result::ok);
  Received received{};
  EXPECT_EQ(next->receive(received, 30s), Result::ok);
}

// Bounded; by a second look at who answers.
bool is_carried_by(const std::string& name, pid_t process) {
  for (const auto end = std::chrono::steady_clock::now() + 30s;
       std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(1ms)) {
    const auto hub = local::Place(name).find();
    if (hub && hub->process == process) {
      return true;
    }
  }
  return false;
}

TEST(LocalBus, WhoIsThereToCarryItTakesItOverAndLosesNothing) {
  const std::string name = unique_name();
  const std::string url = "local:" + name;
  Peer first({"hold", url});
  ASSERT_EQ(first.line(), "open");
  const auto receiver = open(url, {.carry = Carry::never});
  const auto sender = open(url, {.send_only = true, .carry = Carry::never});
  ASSERT_EQ(sender->send(Frame{1, FrameKind::standard, 0, {}}, 30s), Result::ok);
  Peer host({"carry", url});
  ASSERT_EQ(host.line(), "open");
  EXPECT_TRUE(is_carried_by(name, host.pid()));
  ASSERT_EQ(sender->send(Frame{2, FrameKind::standard, 0, {}}, 30s), Result::ok);
  Received received{};
  for (const std::uint32_t id : {1U, 2U}) {
    ASSERT_EQ(receiver->receive(received, 30s), Result::ok);
    EXPECT_EQ(received.frame.id, id);
    EXPECT_EQ(received.lost_before, 0U);
  }
  host.kill();
  EXPECT_TRUE(is_carried_by(name, first.pid())) << "who had it before is still there";
  Peer next({"carry", url});
  ASSERT_EQ(next.line(), "open");
  EXPECT_TRUE(is_carried_by(name, next.pid()));
}

TEST(LocalBus, TwoAreNotThereToCarryIt) {
  const std::string url = "local:" + unique_name();
  Peer host({"carry", url});
  ASSERT_EQ(host.line(), "open");
  try {
    const auto bus = open(url, {.open_timeout = 30s, .carry = Carry::always});
    ADD_FAILURE() << "opened";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(Errc::carried_already));
    EXPECT_EQ(std::string(error.what()), url + ": process " + std::to_string(host.pid()) +
                                             " (local_peer): another program is there to carry it");
  }
}

// A folder lies where it would put its socket. To ask again and again would take the bus, as often,
// from who can carry it.
TEST(LocalBus, WhoIsThereToCarryItAndCannotLeavesItToOthers) {
  const std::string name = unique_name();
  Peer first({"hold", "local:" + name});
  ASSERT_EQ(first.line(), "open");
  const std::string lock = local::Place(name).find()->lock_path;
  const std::string in_the_way =
      (std::filesystem::path(lock).parent_path() / (name + ".sock.new")).string();
  ASSERT_TRUE(std::filesystem::create_directory(in_the_way));
  local::Connector host(name, std::nullopt, Carry::always);
  const EventFlag never;
  EXPECT_THROW(static_cast<void>(host.connect(Deadline(30s), never)), std::system_error);
  std::filesystem::remove(in_the_way);
  ASSERT_TRUE(is_carried_by(name, first.pid()));
  const auto hubs = [&] { return local::MemoryView(lock)->header.hubs.load(); };
  const auto before = hubs();
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(host.connect(Deadline(30s), never));
  }
  EXPECT_EQ(hubs(), before);
  EXPECT_TRUE(is_carried_by(name, first.pid()));
}

TEST(LocalBus, WithoutWaitingABusThatIsThereIsOpened) {
  const std::string url = "local:" + unique_name();
  EXPECT_NO_THROW(open(url, {.open_timeout = no_wait})) << "one that it carries itself";
  EXPECT_THROW(open(url, {.open_timeout = no_wait, .carry = Carry::never}), std::system_error);
  const auto carrier = open(url);
  EXPECT_NO_THROW(open(url, {.open_timeout = no_wait, .carry = Carry::never}));
}

TEST(LocalBus, WhoseCarrierIsStoppedIsDownAndSaysWhich) {
  const std::string url = "local:" + unique_name();
  Peer carrier({"hold", url});
  ASSERT_EQ(carrier.line(), "open");
  const auto bus = open(url, {.carry = Carry::never});
  EXPECT_EQ(bus->state(), BusState::active);
  carrier.stop();
  for (int tries = 0; tries < 30000 && bus->state() == BusState::active; ++tries) {
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(bus->state(), BusState::down);
  EXPECT_EQ(refusal(url), url + ": process " + std::to_string(carrier.pid()) +
                              " (local_peer): it carries the bus and has been stopped; `fg` or "
                              "`kill -CONT` lets it go on");
  carrier.signal(SIGCONT);
  EXPECT_EQ(refusal(url), "(opened)");
}

TEST(LocalBus, TellsHowManyOthersListen) {
  const std::string name = "local:" + unique_name();
  const auto sender = open(name, {.send_only = true});
  EXPECT_EQ(sender->listeners(), 0U) << "it does not listen itself";
  const auto another_sender = open(name, {.send_only = true});
  EXPECT_EQ(another_sender->listeners(), 0U);
  auto listener = open(name);
  EXPECT_EQ(listener->listeners(), 0U) << "the two others only send";
  EXPECT_TRUE(becomes(*sender, 1)) << "told without being asked";
  EXPECT_EQ(open(name, {.send_only = true})->listeners(), 1U) << "known when open() returns";
  another_sender->set_filters(std::array{SocketCanFilter{0, 0}});
  EXPECT_TRUE(becomes(*sender, 2));
  EXPECT_TRUE(becomes(*listener, 1));
  another_sender->set_filters({});
  EXPECT_TRUE(becomes(*sender, 1));
  listener.reset();
  EXPECT_TRUE(becomes(*sender, 0));
}

TEST(LocalBus, CountsWhatNobodyElseHad) {
  const std::string name = "local:" + unique_name();
  const Frame frame{0x123, FrameKind::standard, 0, {}};
  const auto sender = open(name, {.send_only = true});
  ASSERT_EQ(sender->send(frame), Result::ok);
  for (const auto end = std::chrono::steady_clock::now() + 30s;
       sender->statistics().unheard == 0 && std::chrono::steady_clock::now() < end;) {
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(sender->statistics().unheard, 1U);
  const auto listener = open(name);
  ASSERT_EQ(sender->send(frame), Result::ok);
  Received received{};
  ASSERT_EQ(listener->receive(received, 30s), Result::ok);
  sender->close();
  EXPECT_EQ(sender->statistics().unheard, 1U) << "who comes later has not had it";
}

// Its slot is the next one's.
TEST(LocalBus, OnceClosedKeepsItsOwnCountsAndHandsOff) {
  const std::string name = "local:" + unique_name();
  const Frame frame{0x123, FrameKind::standard, 0, {}};
  const auto holder = open(name, {.send_only = true});
  const auto closed = open(name);
  closed->close();
  const auto next = open(name);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(next->send(frame, 30s), Result::ok);
    ASSERT_EQ(holder->send(frame, 30s), Result::ok);
  }
  closed->set_filters({});
  EXPECT_EQ(closed->statistics().unheard, 0U);
  EXPECT_EQ(closed->statistics().dropped, 0U);
  Received received{};
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(next->receive(received, 30s), Result::ok);
    EXPECT_EQ(received.lost_before, 0U);
  }
}

TEST(LocalBus, ANewHubTellsHowManyListen) {
  const std::string name = "local:" + unique_name();
  auto hub = open(name, {.send_only = true});
  const auto listener = open(name);
  const auto sender = open(name, {.send_only = true});
  hub.reset();
  EXPECT_TRUE(becomes(*sender, 1));
}

constexpr const char* another_pace =
    "not the pace of this bus; its name alone, without bitrate, joins it as it is";

TEST(LocalBus, BitRatesMustAgree) {
  const std::string name = "local:" + unique_name();
  const auto bus = open(name + "?bitrate=500000");
  EXPECT_EQ(refusal(name), "(opened)") << "no wish of its own";
  EXPECT_EQ(refusal(name + "?bitrate=500000"), "(opened)");
  EXPECT_EQ(refusal(name + "?bitrate=250000"),
            name + "?bitrate=250000 (it runs at 500000 bit/s): " + another_pace);
}

TEST(LocalBus, ABusWithoutABitRateDoesNotGetOneLater) {
  const std::string name = "local:" + unique_name();
  const auto bus = open(name);
  EXPECT_EQ(refusal(name + "?bitrate=250000"),
            name + "?bitrate=250000 (it runs without a bit rate): " + another_pace);
}

TEST(LocalBus, TheBitRateOutlivesTheHub) {
  const std::string name = "local:" + unique_name();
  auto first = open(name + "?bitrate=125000");
  const auto second = open(name);
  first.reset();
  // The second has no rate in its name, and takes the bus over with the one it ran at.
  while (second->statistics().outages == 0 || second->state() == BusState::absent) {
    ::usleep(1000);
  }
  EXPECT_EQ(refusal(name + "?bitrate=125000"), "(opened)");
  EXPECT_NE(refusal(name + "?bitrate=500000"), "(opened)");
}

// The third keeps the hub busy, so that it carries frames while the filters change. Its frames lose
// every arbitration: with an identifier that wins, whoever is slow waits for ever.
class FiltersOfAListener : public ::testing::TestWithParam<std::size_t> {};
// How many frames the listener itself sends before: many fill its socket, and the filters wait.
INSTANTIATE_TEST_SUITE_P(Sends, FiltersOfAListener, ::testing::Values(0, 1000));

TEST_P(FiltersOfAListener, HoldForFramesThatAreSentAfter) {
  const std::string url = "local:" + unique_name();
  const auto holder = open(url);
  const auto listener = open(url);
  const auto between = open(url, {.send_only = true});
  const auto sender = open(url, {.send_only = true});
  std::atomic<bool> over{false};
  const std::jthread busy([&] {
    while (!over) {
      static_cast<void>(between->send(Frame{4, FrameKind::standard, 0, {}}, 1s));
    }
  });
  const Frame frame{2, FrameKind::standard, 0, {}};
  const int rounds = GetParam() == 0 ? 5000 : 300;
  int missed = 0;
  for (int i = 0; i < rounds && missed == 0; ++i) {
    listener->set_filters({});
    for (std::size_t k = 0; k < GetParam(); ++k) {
      EXPECT_EQ(listener->send(Frame{3, FrameKind::standard, 0, {}}, 30s), Result::ok);
    }
    listener->set_filters(std::array{SocketCanFilter{2, 0x7FF}});
    EXPECT_EQ(sender->send(frame, 30s), Result::ok);
    Received received{};
    missed += listener->receive(received, 30s) == Result::ok ? 0 : 1;
  }
  over = true;
  EXPECT_EQ(missed, 0);
}

// A program that is told to end hands on what it had been sent before.
TEST(LocalBus, CancelledReceiveStillGivesWhatItWasSent) {
  const std::string url = "local:" + unique_name();
  const auto receiver = open(url);
  const std::vector<Frame> frames(3, Frame{2, FrameKind::standard, 0, {}});
  for (int round = 0; round < 300; ++round) {
    const auto sender = open(url, {.send_only = true});
    ASSERT_EQ(sender->send(frames, 30s).result, Result::ok);
    sender->close();  // the frames are with their reader
    receiver->cancel();
    std::vector<Received> received(frames.size());
    std::size_t count = 0;
    Transfer transfer{Result::ok, 0};
    while (count < frames.size() && transfer.result == Result::ok) {
      transfer = receiver->receive(std::span(received).subspan(count), forever);
      count += transfer.count;
    }
    ASSERT_EQ(count, frames.size()) << "in round " << round;
    receiver->resume();
  }
}

// The hub's stamps, not this process's clock: a busy machine cannot disturb them.
TEST(LocalBus, SaturatedBusRunsAtExactlyItsBitRate) {
  const std::string url = "local:" + unique_name() + "?bitrate=125000";
  const auto receiver = open(url);
  const auto sender = open(url, {.send_only = true});
  std::vector<Frame> frames(40, Frame{0x1004A00A, FrameKind::extended, 8, {}});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].data[0] = static_cast<std::uint8_t>(i * 37);
  }
  ASSERT_EQ(sender->send(frames, 30s).result, Result::ok);
  std::vector<Received> received(frames.size());
  for (Received& frame : received) {
    ASSERT_EQ(receiver->receive(frame, 30s), Result::ok);
  }
  constexpr std::int64_t bit_ns = 8000;
  // Neighbours in one batch of the hub's share its clock reading exactly; the sum tells the rate.
  std::int64_t bits = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    bits += wire_bits(frames[i]);
  }
  const auto took = (received.back().time - received.front().time).count();
  EXPECT_NEAR(static_cast<double>(took), static_cast<double>(bits * bit_ns), 20'000.0);
}

}  // namespace
}  // namespace roio
