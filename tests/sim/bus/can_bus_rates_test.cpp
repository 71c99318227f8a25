// The bus: nodes of other rates than the rest.
#include <gtest/gtest.h>

#include <roio/frame_length.hpp>
#include <roio/sim/can_bus.hpp>

#include "can_bus_rig.hpp"

namespace roio::sim {
namespace {

using std::chrono::milliseconds;

TEST(CanBus, ANodeAtAnotherRateDisturbsTheBusAndFallsSilentItself) {
  for (const std::uint32_t wrong : {125'000U, 250'000U, 400'000U, 1'000'000U}) {
    CanBus bus;
    Station sender(bus);
    Station receiver(bus);
    Station stranger(bus, wrong);
    bus.run_for(milliseconds(1));
    send_without_end(sender, document_frame);
    bus.run_for(milliseconds(100));
    EXPECT_GT(bus.statistics().transmit_errors, 0U) << wrong;
    EXPECT_GE(stranger.receive_errors(), 128U) << wrong;
    EXPECT_NE(stranger.confinement(), Confinement::active) << wrong;
    EXPECT_EQ(stranger.received, Texts{}) << wrong;
  }
}

TEST(CanBus, AStrangersFramesDisturbTheBus) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  Station stranger(bus, 250'000);
  bus.run_for(milliseconds(1));
  stranger.node.send(document_frame);
  bus.run_for(milliseconds(50));
  EXPECT_EQ(stranger.sent, Texts{});
  EXPECT_EQ(a.received, Texts{});
  EXPECT_GE(a.receive_errors(), 128U);
  EXPECT_GE(stranger.transmit_errors(), 128U);
}

TEST(CanBus, AListenerAtAnotherRateDisturbsNobody) {
  for (const std::uint32_t wrong : {125'000U, 250'000U, 1'000'000U}) {
    CanBus bus;
    Station stranger(bus, wrong, Controller::Mode::listen_only);
    Station sender(bus);
    Station receiver(bus);
    bus.run_for(milliseconds(1));
    send_without_end(sender, document_frame);
    const SimTime start = bus.now();
    bus.run_for(bit * 97 * 500);
    EXPECT_EQ(receiver.received.size(), 500U) << wrong;
    EXPECT_EQ(bus.statistics().transmit_errors, 0U) << wrong;
    EXPECT_EQ(bus.statistics().busy, bus.now() - start) << wrong;
    EXPECT_GT(stranger.node.receive_errors_seen(), 0U) << wrong;
    EXPECT_EQ(stranger.receive_errors(), 0U) << wrong;
    EXPECT_EQ(stranger.received, Texts{}) << wrong;
  }
}

TEST(CanBus, WhatAListenerAtAnotherRateMakesOfItIsNoLoad) {
  for (const std::uint32_t wrong : {50'000U, 125'000U, 250'000U}) {
    CanBus bus;
    Station stranger(bus, wrong, Controller::Mode::listen_only);
    Station sender(bus);
    Station receiver(bus);
    bus.run_for(milliseconds(1));
    sender.node.send(document_frame);
    bus.run_for(milliseconds(2));
    EXPECT_EQ(bus.statistics().busy, bit * 97) << wrong;
  }
}

TEST(CanBus, NodesAFewThousandthsApartFollowOneAnother) {
  // Half a percent and one percent: what crystals and ceramic resonators make of 500 kbit/s.
  for (const std::uint32_t other : {497'500U, 502'500U, 505'000U}) {
    CanBus bus;
    Station a(bus);
    Station b(bus);
    Station c(bus, other);
    bus.run_for(milliseconds(1));
    std::mt19937 generator = test::seeded_generator();
    Texts from_a;
    Texts from_c;
    SimTime busy{0};
    for (int i = 0; i < 500; ++i) {
      Frame frame = test::random_frame(generator);
      frame.length = static_cast<std::uint8_t>(frame.length % 9);
      frame.kind = FrameKind::extended;
      frame.id = UINT32_C(0x10000000) | (frame.id & UINT32_C(0xFFFFFE));
      a.node.send(frame);
      from_a.push_back(text_of(frame));
      busy += bit * wire_bits(frame);
      frame.id |= 1U;
      busy += bit * wire_bits(frame);
      c.node.send(frame);
      from_c.push_back(text_of(frame));
    }
    bus.run_for(std::chrono::seconds(1));
    EXPECT_EQ(bus.statistics().transmit_errors, 0U) << other;
    EXPECT_EQ(c.received, from_a) << other;
    EXPECT_EQ(a.received, from_c) << other;
    EXPECT_EQ(a.receive_errors() + b.receive_errors() + c.receive_errors(), 0U) << other;
    // Time in which nodes of both rates are busy counts once.
    EXPECT_LT(bus.statistics().busy, busy * 102 / 100) << other;
    EXPECT_GT(bus.statistics().busy, busy * 98 / 100) << other;
  }
}

TEST(CanBus, AStartOfFrameAtAnyMomentSynchronisesNodesOfOtherRates) {
  CanBus bus;
  Station a(bus);
  Station c(bus, 502'500);
  Station cut(bus);
  bus.run_for(milliseconds(1));
  // While this one is bus-off, bits are counted, and time does not stand still between frames.
  cut.node.controller().cut_transmitter(true);
  cut.node.send(document_frame);
  bus.run_for(milliseconds(1));
  ASSERT_EQ(cut.confinement(), Confinement::bus_off);
  for (int i = 0; i < 8; ++i) {
    (i % 2 == 0 ? a : c).node.send(document_frame);
    bus.run_for(std::chrono::microseconds(250) + bit * i / 8);
  }
  ASSERT_EQ(cut.confinement(), Confinement::bus_off);
  EXPECT_EQ(a.received.size(), 4U);
  EXPECT_EQ(c.received.size(), 4U);
  EXPECT_EQ(a.transmit_errors() + a.receive_errors(), 0U);
  EXPECT_EQ(c.transmit_errors() + c.receive_errors(), 0U);
}

TEST(CanBus, NodesOfSeveralRatesThatStartTogetherBothStart) {
  // Whoever joined first; the weaker one loses arbitration, and neither waits for the other.
  for (const bool order : {false, true}) {
    CanBus bus;
    Station a(bus, order ? 500'000 : 501'000);
    Station b(bus, order ? 501'000 : 500'000);
    bus.run_for(milliseconds(1));
    a.node.send(extended(0x10000002));
    b.node.send(extended(0x10000001));
    bus.run_for(milliseconds(1));
    EXPECT_EQ(a.received, Texts{text_of(extended(0x10000001))}) << order;
    EXPECT_EQ(b.received, Texts{text_of(extended(0x10000002))}) << order;
    EXPECT_EQ(bus.statistics().arbitrations_lost, 1U) << order;
  }
}

}  // namespace
}  // namespace roio::sim
