// What a board stands on: CanBus::Companion, called between the actions and the bits.
#include <gtest/gtest.h>

#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <stdexcept>
#include <vector>

namespace roio::test {
namespace {

using namespace std::chrono_literals;

struct Walker : sim::CanBus::Companion {
  explicit Walker(sim::CanBus& on, std::optional<sim::SimTime> first) : bus(on) {
    next = first;
    bus.attach(*this);
  }
  ~Walker() override { bus.detach(*this); }
  Walker(const Walker&) = delete;
  Walker& operator=(const Walker&) = delete;
  void step() override {
    called.push_back(bus.now());
    quiet.push_back(bus.quiet_until(*this));
    next = bus.now() + 10us;
    if (fails) {
      next.reset();
      throw std::runtime_error("it fails");
    }
  }
  sim::CanBus& bus;
  std::vector<sim::SimTime> called;
  std::vector<sim::SimTime> quiet;
  bool fails = false;
};

using Times = std::vector<sim::SimTime>;

TEST(Companion, IsCalledWhenItAskedFor) {
  sim::CanBus bus;
  const Walker walker(bus, 5us);
  bus.run_until(25us);
  EXPECT_EQ(walker.called, (Times{5us, 15us, 25us}));
}

TEST(Companion, WithoutATimeIsNotCalled) {
  sim::CanBus bus;
  const Walker walker(bus, std::nullopt);
  bus.run_until(1ms);
  EXPECT_TRUE(walker.called.empty());
  EXPECT_EQ(bus.now(), sim::SimTime(1ms));
}

TEST(Companion, KnowsHowFarItIsQuiet) {
  sim::CanBus bus;
  const Walker walker(bus, 5us);
  Walker other(bus, 12us);
  other.reach = 2us;
  bus.at(18us, [] {});
  bus.run_until(20us);
  EXPECT_EQ(walker.called, (Times{5us, 15us}));
  EXPECT_EQ(walker.quiet, (Times{14us, 18us})) << "the other one's reach, the action";
  EXPECT_EQ(other.quiet, (Times{15us})) << "the first one's time";
  EXPECT_EQ(bus.quiet_until(walker), bus.now()) << "nothing is under way";
}

TEST(Companion, TheEndOfARunAndTheNextBitEndTheQuiet) {
  sim::CanBus bus;
  sim::HostNode sender(bus, 500'000);
  const sim::HostNode receiver(bus, 500'000);
  const Walker walker(bus, 100us);
  bus.run_until(105us);
  EXPECT_EQ(walker.quiet, (Times{105us}));
  sender.send(Frame{0x123, FrameKind::standard, 8, {}});
  bus.run_until(110us);
  ASSERT_EQ(walker.quiet.size(), 2U);
  EXPECT_GE(walker.quiet[1], bus.now());
  bus.run_until(125us);
  ASSERT_EQ(walker.quiet.size(), 3U);
  EXPECT_LE(walker.quiet[2], 122us) << "bits of 2 us";
}

TEST(Companion, WhatItThrowsEndsTheRunAndNotTheBus) {
  sim::CanBus bus;
  Walker walker(bus, 5us);
  walker.fails = true;
  EXPECT_THROW(bus.run_until(20us), std::runtime_error);
  EXPECT_EQ(bus.now(), sim::SimTime(5us));
  EXPECT_EQ(bus.quiet_until(walker), bus.now());
  bus.run_until(20us);
  EXPECT_EQ(bus.now(), sim::SimTime(20us));
}

}  // namespace
}  // namespace roio::test
