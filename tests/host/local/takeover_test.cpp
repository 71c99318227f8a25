// The hub's process ends, is killed, or is stopped while others use the bus: they go on, nothing is
// delivered twice, nothing is lost without being counted.
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <roio.hpp>

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

// What a killed hub still held for a reader that did not read is lost, and the reader can tell how
// much.
TEST(TakeoverDetails, LossWithAKilledHubIsCounted) {
  const std::string url = "local:" + unique_name();
  constexpr std::uint64_t count = 60'000;
  Peer hub({"hold", url});
  ASSERT_EQ(hub.line(), "open");
  Peer reader({"receive", url, count_text(count + 1)});
  ASSERT_EQ(reader.line(), "open");
  reader.signal(SIGSTOP);
  Peer witness({"receive", url, count_text(count + 1)});
  ASSERT_EQ(witness.line(), "open");
  const auto bus = open(url, {.send_only = true});
  expect_sent(*bus, 0, count + 1);
  // All are reported done before the hub dies: nothing of these can be sent again.
  EXPECT_EQ(without_outages(witness.line()),
            "received=" + count_text(count + 1) + " lost=0 dropped=0 wrong=0");
  bus->close();
  ASSERT_EQ(bus->statistics().unsent, 0U);
  hub.signal(SIGKILL);
  const auto next = open(url, {.send_only = true});  // the hub, since the reader is stopped
  reader.signal(SIGCONT);
  expect_sent(*next, count + 1, count + 2);
  const std::string line = reader.line();
  std::uint64_t received = 0;
  std::uint64_t lost = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "received=%lu lost=%lu", &received, &lost), 2) << line;
  EXPECT_GT(lost, 0U) << line;
  EXPECT_GE(received + lost, count + 1) << line;
  EXPECT_LE(received + lost, count + 2) << line;
  EXPECT_NE(line.find(" wrong=0 "), std::string::npos) << line;
}

}  // namespace
}  // namespace roio
