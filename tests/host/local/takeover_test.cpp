// The hub's process ends, is killed, or is stopped while others use the bus: they go on, nothing is
// delivered twice, nothing is lost without being counted.
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <roio.hpp>
#include <thread>

#include "local/hub.hpp"
#include "local/presence.hpp"
#include "process.hpp"

namespace roio {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::unique_name;

Frame numbered(std::uint64_t number) {
  Frame frame{0x1004A00A, FrameKind::extended, 8, {}};
  std::memcpy(frame.data, &number, sizeof number);
  return frame;
}

std::string count_text(std::uint64_t count) {
  return std::to_string(count);
}

// How often a hub left depends on which receiver is done first; what was received does not.
std::string without_outages(const std::string& line) {
  return line.substr(0, line.rfind(" outages="));
}

void expect_sent(Bus& bus, std::uint64_t first, std::uint64_t end) {
  for (std::uint64_t number = first; number < end; ++number) {
    ASSERT_EQ(bus.send(numbered(number), 30s), Result::ok) << "frame " << number;
  }
}

class Takeover : public ::testing::TestWithParam<const char*> {
 protected:
  // Who opens first is the hub.
  std::string url_ = "local:" + unique_name() + GetParam();
  std::uint64_t half_ = std::string(GetParam()).empty() ? 20'000 : 500;
};
INSTANTIATE_TEST_SUITE_P(Buses, Takeover, ::testing::Values("", "?bitrate=1000000"),
                         [](const auto& bus) { return *bus.param == 0 ? "AsFast" : "Paced"; });

TEST_P(Takeover, HubKilledInTheMiddleOfAFlood) {
  Peer hub({"hold", url_});
  ASSERT_EQ(hub.line(), "open");
  Peer first({"receive", url_, count_text(2 * half_)});
  ASSERT_EQ(first.line(), "open");
  Peer second({"receive", url_, count_text(2 * half_)});
  ASSERT_EQ(second.line(), "open");
  const auto bus = open(url_, {.send_only = true});
  expect_sent(*bus, 0, half_);
  hub.signal(SIGKILL);
  expect_sent(*bus, half_, 2 * half_);
  const std::string all = "received=" + count_text(2 * half_) + " lost=0 dropped=0 wrong=0";
  EXPECT_EQ(without_outages(first.line()), all);
  EXPECT_EQ(without_outages(second.line()), all);
  bus->close();
  EXPECT_GE(bus->statistics().outages, 1U);
  EXPECT_EQ(bus->statistics().unsent, 0U);
}

TEST_P(Takeover, HubThatIsAReceiverKilledThreeTimesOver) {
  std::vector<std::unique_ptr<Peer>> peers;
  for (int i = 0; i < 4; ++i) {
    peers.push_back(
        std::make_unique<Peer>(std::vector<std::string>{"receive", url_, count_text(2 * half_)}));
    ASSERT_EQ(peers.back()->line(), "open");
  }
  const auto bus = open(url_, {.send_only = true});
  for (std::uint64_t i = 0; i < 3; ++i) {
    expect_sent(*bus, i * half_ / 2, (i + 1) * half_ / 2);
    peers.at(i)->signal(SIGKILL);
  }
  expect_sent(*bus, 3 * half_ / 2, 2 * half_);
  EXPECT_EQ(without_outages(peers.back()->line()),
            "received=" + count_text(2 * half_) + " lost=0 dropped=0 wrong=0");
}

TEST_P(Takeover, HubThatIsTheSenderEndsInOrder) {
  Peer sender({"send", url_, count_text(half_)});
  ASSERT_EQ(sender.line(), "open");
  const std::string line = sender.line();
  EXPECT_EQ(line, "sent=" + count_text(half_) + " all=yes unsent=0");
  EXPECT_EQ(sender.line(), "(end)");
  const auto bus = open(url_);
  EXPECT_EQ(bus->state(), BusState::active);
}

TEST(TakeoverDetails, SenderInTheHubsOwnProcessClosesWithoutLosingFrames) {
  const std::string url = "local:" + unique_name();
  constexpr std::uint64_t count = 30'000;
  auto bus = open(url, {.send_only = true});
  Peer receiver({"receive", url, count_text(count)});
  ASSERT_EQ(receiver.line(), "open");
  expect_sent(*bus, 0, count);
  bus->close();
  EXPECT_EQ(bus->statistics().unsent, 0U);
  EXPECT_EQ(without_outages(receiver.line()),
            "received=" + count_text(count) + " lost=0 dropped=0 wrong=0");
}

// A reader that is stopped while one hub is killed and another ends; it comes over to a third.
struct Account {
  std::uint64_t received = 0;
  std::uint64_t lost = 0;
  std::uint64_t missing = 0;
  std::uint64_t wrong = 0;
};

Account stopped_over_two_hubs(std::uint64_t count) {
  const std::string url = "local:" + unique_name();
  Peer killed({"hold", url});
  EXPECT_EQ(killed.line(), "open");
  Peer reader({"listen", url});
  EXPECT_EQ(reader.line(), "open");
  reader.stop();
  const auto bus = open(url, {.send_only = true, .carry = Carry::never});
  expect_sent(*bus, 0, count / 3);
  killed.kill();
  Peer ended({"hold", url});
  EXPECT_EQ(ended.line(), "open");
  expect_sent(*bus, count / 3, 2 * count / 3);
  ended.tell("");
  EXPECT_EQ(ended.line(), "(end)");
  Peer next({"hold", url});
  EXPECT_EQ(next.line(), "open");
  expect_sent(*bus, 2 * count / 3, count);
  bus->close();
  reader.signal(SIGCONT);
  reader.tell(count_text(count));
  const std::string line = reader.line();
  Account account;
  EXPECT_EQ(std::sscanf(line.c_str(), "received=%lu lost=%lu missing=%lu wrong=%lu",
                        &account.received, &account.lost, &account.missing, &account.wrong),
            4)
      << line;
  return account;
}

TEST(TakeoverDetails, AReaderStoppedOverTwoHubsHasAllThatIsKept) {
  const Account account = stopped_over_two_hubs(60'000);
  EXPECT_EQ(account.received, 60'000U);
  EXPECT_EQ(account.lost + account.missing + account.wrong, 0U);
}

TEST(TakeoverDetails, WhatAReaderStoppedOverTwoHubsLosesIsToldExactly) {
  constexpr std::uint64_t count = 150'000;
  const Account account = stopped_over_two_hubs(count);
  EXPECT_EQ(account.received + account.lost, count);
  EXPECT_EQ(account.missing, account.lost);
  EXPECT_GT(account.lost, 0U);
  EXPECT_EQ(account.wrong, 0U);
}

// What a hub leaves behind that was killed between any two of its instructions.
class LeftBehind : public ::testing::Test {
 protected:
  static constexpr std::uint64_t client = 4711;

  void SetUp() override {
    memory_.set_up(0);
    memory_->slots.at(0).client = client;
    memory_->header.head = local::log_size + 1000;
  }

  void store(std::uint64_t number, std::uint64_t sequence) {
    local::store(local::entry_of(*memory_, number), {client, sequence, normal_lane, 0, {}});
  }
  // As the next hub finds it.
  std::uint64_t done_after_takeover() {
    const local::Hub next(std::move(seat_), std::nullopt, 0);
    return memory_->slots.at(0).done.at(normal_lane);
  }

  const std::string name_ = unique_name();
  local::HubSeat seat_ = local::Place(name_).claim().value();
  local::HubMemory memory_{seat_.lock_fd()};
  local::Presence presence_{local::folders().front() + "/" + name_ + ".lock", client};
};

TEST_F(LeftBehind, AFrameThatIsInTheLogIsDoneThoughNobodyWasTold) {
  store(memory_->header.head, 7);
  EXPECT_EQ(done_after_takeover(), 7U);
}

TEST_F(LeftBehind, AFrameThatWasOnItsWayIntoTheLogIsNot) {
  store(memory_->header.head, 7);
  store(memory_->header.head + 1, 8);
  EXPECT_EQ(done_after_takeover(), 7U);
}

}  // namespace
}  // namespace roio
