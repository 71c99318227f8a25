// The interface goes and comes back; the same object goes on.
#include <gtest/gtest.h>
#include <poll.h>

#include <array>
#include <roio.hpp>
#include <thread>

#include "lab_support.hpp"

namespace roio::lab {
namespace {

using OutageTest = LabTestThatChangesTheInterface;

constexpr SocketCanFilter only_123{0x123, 0xC00007FF};

bool readable(const Bus& bus, int timeout_ms) {
  pollfd entry{bus.fd(), POLLIN, 0};
  return ::poll(&entry, 1, timeout_ms) == 1;
}

/// As an event loop does it: after the descriptor was readable, receive() until it has no more.
std::vector<Received> handle_event(Bus& bus) {
  std::vector<Received> all;
  Received one;
  while (bus.receive(one, no_wait) == Result::ok) {
    all.push_back(one);
  }
  return all;
}

TEST_F(OutageTest, DownAndUpAgainWhileReceiving) {
  const auto bus = open("vcan0");
  EXPECT_EQ(bus->state(), BusState::active);
  Received received{};
  std::thread receiver([&] { EXPECT_EQ(bus->receive(received, patience), Result::ok); });
  shell("ip link set vcan0 down");
  EXPECT_TRUE(eventually([&] { return bus->state() == BusState::down; }));
  shell("ip link set vcan0 up && cansend vcan0 123#1122");
  receiver.join();
  EXPECT_EQ(to_text(received.frame), "123#1122");
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(bus->statistics().outages, 1U);
}

TEST_F(OutageTest, AnOutageThatNobodySawIsCountedOnceAndHurtsNobody) {
  const auto bus = open("vcan0");
  shell("ip link set vcan0 down && ip link set vcan0 up && cansend vcan0 123#");
  EXPECT_EQ(texts(receive_exactly(*bus, 1)), std::vector<std::string>{"123#"});
  EXPECT_EQ(bus->statistics().outages, 1U);
  shell("ip link set vcan0 down && ip link set vcan0 up");
  EXPECT_EQ(bus->send(frame("123#"), no_wait), Result::ok) << "over already";
  EXPECT_EQ(bus->statistics().outages, 2U);
}

TEST_F(OutageTest, FramesThatWaitedBeforeItAreNotLost) {
  const auto bus = open("vcan0");
  shell("cansend vcan0 123#01; cansend vcan0 123#02; ip link set vcan0 down");
  EXPECT_EQ(texts(receive_all(*bus)), (std::vector<std::string>{"123#01", "123#02"}));
  EXPECT_EQ(bus->state(), BusState::down);
}

TEST_F(OutageTest, SendingWaitsForTheInterfaceToItsDeadline) {
  const auto bus = open("vcan0");
  const auto listener = open("vcan0");
  shell("ip link set vcan0 down");
  EXPECT_EQ(bus->send(frame("123#01"), no_wait), Result::timeout);
  EXPECT_EQ(bus->send(frame("123#02"), a_moment), Result::timeout);
  std::thread sender([&] { EXPECT_EQ(bus->send(frame("123#03"), patience), Result::ok); });
  shell("sleep 0.2; ip link set vcan0 up");
  sender.join();
  EXPECT_EQ(texts(receive_all(*listener)), std::vector<std::string>{"123#03"});
  const Statistics statistics = bus->statistics();
  EXPECT_EQ(statistics.sent, 1U);
  EXPECT_EQ(statistics.send_timeouts, 2U);
  EXPECT_EQ(statistics.send_waits, 0U) << "no queue was full";
  EXPECT_EQ(statistics.outages, 1U);
}

TEST_F(OutageTest, OpensAnInterfaceThatIsDown) {
  shell("ip link set vcan0 down");
  const auto bus = open("vcan0");
  EXPECT_EQ(bus->state(), BusState::down);
  EXPECT_TRUE(receive_all(*bus).empty());
  shell("ip link set vcan0 up; cansend vcan0 123#");
  EXPECT_EQ(receive_exactly(*bus, 1).size(), 1U);
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(bus->statistics().outages, 0U) << "it did not go down in our time";
}

TEST_F(OutageTest, DeletedAndMadeAgainKeepsTheFilters) {
  const auto bus = open("vcan0");
  const auto listener = open("vcan0");
  bus->set_filters(std::array{only_123});
  Received received{};
  std::thread receiver([&] { EXPECT_EQ(bus->receive(received, patience), Result::ok); });
  shell("ip link del vcan0");
  EXPECT_TRUE(eventually([&] { return bus->state() == BusState::absent; }));
  EXPECT_EQ(bus->send(frame("124#"), no_wait), Result::timeout);
  shell("ip link add vcan0 type vcan && ip link set vcan0 up");
  EXPECT_TRUE(eventually([&] { return bus->state() == BusState::active; }));
  shell("cansend vcan0 122#; cansend vcan0 00000123#; cansend vcan0 123#AA");
  receiver.join();
  EXPECT_EQ(to_text(received.frame), "123#AA");
  EXPECT_EQ(bus->statistics().outages, 1U);

  EXPECT_EQ(listener->state(), BusState::active) << "bound anew by the call itself";
  EXPECT_EQ(bus->send(frame("124#"), no_wait), Result::ok);
  EXPECT_EQ(texts(receive_exactly(*listener, 1)), std::vector<std::string>{"124#"});
}

TEST_F(OutageTest, FiltersSetWhileItIsAwayHoldWhenItIsBack) {
  const auto bus = open("vcan0");
  shell("ip link del vcan0");
  bus->set_filters(std::array{only_123});
  shell("ip link add vcan0 type vcan && ip link set vcan0 up");
  EXPECT_EQ(bus->state(), BusState::active);
  shell("cansend vcan0 122#; cansend vcan0 123#");
  EXPECT_EQ(texts(receive_all(*bus)), std::vector<std::string>{"123#"});
}

TEST_F(OutageTest, TheDescriptorStaysAndWakesAnEventLoopForTheNewInterface) {
  const auto bus = open("vcan0");
  const int fd = bus->fd();
  EXPECT_FALSE(readable(*bus, 0));
  shell("ip link del vcan0; ip link add vcan0 type vcan");
  EXPECT_TRUE(readable(*bus, 20000));
  EXPECT_TRUE(handle_event(*bus).empty());
  shell("ip link set vcan0 up");
  EXPECT_TRUE(readable(*bus, 20000));
  EXPECT_TRUE(handle_event(*bus).empty());
  EXPECT_TRUE(eventually([&] {
    handle_event(*bus);
    return !readable(*bus, 50);
  })) << "nothing left to look at";
  shell("cansend vcan0 123#");
  EXPECT_TRUE(readable(*bus, 20000));
  EXPECT_EQ(texts(handle_event(*bus)), std::vector<std::string>{"123#"});
  EXPECT_EQ(bus->fd(), fd);
}

TEST_F(OutageTest, CancelAndCloseEndAWaitForTheInterface) {
  const auto bus = open("vcan0");
  shell("ip link del vcan0");
  const auto when_absent = [&](auto action) {
    return std::thread([&bus, action] {
      EXPECT_TRUE(eventually([&] { return bus->state() == BusState::absent; }));
      action();
    });
  };
  Received received{};
  std::thread canceller = when_absent([&] { bus->cancel(); });
  EXPECT_EQ(bus->receive(received, forever), Result::cancelled);
  canceller.join();
  EXPECT_EQ(bus->send(frame("123#"), forever), Result::cancelled) << "until resume()";
  bus->resume();
  std::thread closer = when_absent([&] { bus->close(); });
  EXPECT_EQ(bus->send(frame("123#"), forever), Result::closed);
  closer.join();
  EXPECT_EQ(bus->receive(received, forever), Result::closed);
}

TEST_F(OutageTest, AfterCloseTheKernelQueuesNothingMore) {
  const auto bus = open("vcan0");
  EXPECT_EQ(listeners("vcan0"), 1);
  bus->close();
  EXPECT_EQ(listeners("vcan0"), 0);
  shell("ip link del vcan0; ip link add vcan0 type vcan; ip link set vcan0 up");
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(listeners("vcan0"), 0) << "nor on the next interface";
}

}  // namespace
}  // namespace roio::lab
