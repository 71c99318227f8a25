#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include <roio/sim/host_node.hpp>

#include "wire_text.hpp"

namespace roio::sim {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t rate = 500'000;

Frame numbered(std::uint32_t id, std::uint8_t number) {
  return {id, FrameKind::extended, 1, {number}};
}

TEST(HostNode, UrgentFramesGoAheadAndOrderIsKeptWithinAPriority) {
  CanBus bus;
  HostNode sender(bus, rate);
  HostNode receiver(bus, rate);
  std::vector<int> numbers;
  receiver.on_receive([&](const Frame& frame) { numbers.push_back(frame.data[0]); });
  sender.send(numbered(0x10000002, 1));
  sender.send(numbered(0x10000001, 2));
  sender.send(numbered(0x00000002, 3));
  sender.send({0x7FF, FrameKind::standard, 1, {4}});
  sender.send(numbered(0x00000001, 5));
  EXPECT_EQ(sender.waiting(), 5U);
  bus.run_for(milliseconds(2));
  EXPECT_EQ(numbers, (std::vector<int>{3, 5, 1, 2, 4}));
  EXPECT_EQ(sender.waiting(), 0U);
}

TEST(HostNode, AnUrgentFrameDoesNotMixWithTheOneOnTheWire) {
  CanBus bus;
  HostNode sender(bus, rate);
  HostNode receiver(bus, rate);
  std::vector<int> sent;
  std::vector<int> received;
  sender.on_sent([&](const Frame& frame) { sent.push_back(frame.data[0]); });
  receiver.on_receive([&](const Frame& frame) { received.push_back(frame.data[0]); });
  bus.run_for(milliseconds(1));
  sender.send(numbered(0x10000001, 1));
  sender.send(numbered(0x10000001, 2));
  bus.run_for(cycles(50, rate));
  sender.send(numbered(0x00000001, 3));
  bus.run_for(milliseconds(1));
  EXPECT_EQ(sent, (std::vector<int>{1, 3, 2}));
  EXPECT_EQ(received, sent);
}

TEST(HostNode, MaySendFromItsCallbacks) {
  CanBus bus;
  HostNode sender(bus, rate);
  HostNode echo(bus, rate);
  int rounds = 0;
  echo.on_receive([&](const Frame& frame) { echo.send(frame); });
  sender.on_receive([&](const Frame& frame) {
    if (++rounds < 10) {
      sender.send(frame);
    }
  });
  sender.send(numbered(0x10000001, 1));
  bus.run_for(milliseconds(10));
  EXPECT_EQ(rounds, 10);
}

TEST(HostNode, GetsTheDlcAsItWasSent) {
  CanBus bus;
  HostNode sender(bus, rate);
  HostNode receiver(bus, rate);
  std::vector<Frame> received;
  receiver.on_receive([&](const Frame& frame) { received.push_back(frame); });
  const Frame frame{0x123, FrameKind::standard, 12, {1, 2, 3, 4, 5, 6, 7, 8}};
  sender.send(frame);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(test::text_of(received), test::text_of(std::vector<Frame>{frame}));
}

TEST(HostNode, RefusesWhatIsNoFrame) {
  CanBus bus;
  HostNode node(bus, rate);
  const Frame wrong[] = {{0x800, FrameKind::standard, 0, {}},
                         {0x20000000, FrameKind::extended, 0, {}},
                         {0x4, FrameKind::error, 8, {}},
                         {0x1, FrameKind::extended, 16, {}}};
  for (const Frame& frame : wrong) {
    EXPECT_THROW(node.send(frame), std::invalid_argument);
  }
  EXPECT_EQ(node.waiting(), 0U);
}

TEST(HostNode, CountsTheErrorsThatItSees) {
  CanBus bus;
  HostNode sender(bus, rate);
  HostNode receiver(bus, rate);
  bus.run_for(milliseconds(1));
  sender.send(numbered(0x10000001, 1));
  bus.after(cycles(50, rate), [&] { bus.flip_next_bit(&receiver.controller()); });
  bus.run_for(milliseconds(1));
  EXPECT_EQ(receiver.receive_errors_seen(), 1U);
  EXPECT_EQ(sender.receive_errors_seen(), 0U);
}

}  // namespace
}  // namespace roio::sim
