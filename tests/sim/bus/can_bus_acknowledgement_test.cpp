// Who acknowledges a frame, and what becomes of a node whose frames nobody does.
#include <gtest/gtest.h>

#include <roio/sim/can_bus.hpp>
#include <vector>

#include "can_bus_rig.hpp"

namespace roio::sim {
namespace {

using std::chrono::milliseconds;

TEST(CanBus, ALoneNodeRetriesBecomesErrorPassiveAndNeverBusOff) {
  CanBus bus;
  Station lone(bus);
  bus.run_for(milliseconds(1));
  lone.node.send(document_frame);
  std::vector<unsigned> counts;
  for (int i = 0; i < 17; ++i) {
    const std::uint64_t before = bus.statistics().transmit_errors;
    while (bus.statistics().transmit_errors == before) {
      bus.run_for(bit);
    }
    counts.push_back(lone.transmit_errors());
  }
  EXPECT_EQ(counts, (std::vector<unsigned>{8, 16, 24, 32, 40, 48, 56, 64, 72, 80, 88, 96, 104, 112,
                                           120, 128, 128}));
  bus.run_for(std::chrono::seconds(1));
  EXPECT_EQ(lone.transmit_errors(), 128U);
  EXPECT_EQ(lone.confinement(), Confinement::passive);
  EXPECT_EQ(bus.statistics().frames, 0U);
  EXPECT_EQ(lone.node.waiting(), 1U);
  EXPECT_GT(bus.statistics().transmit_errors, 3000U);

  Station other(bus);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(other.received, Texts{text_of(document_frame)});
  EXPECT_EQ(lone.sent, Texts{text_of(document_frame)});
  EXPECT_EQ(lone.transmit_errors(), 127U);
  EXPECT_EQ(lone.confinement(), Confinement::active);
}

TEST(CanBus, AListenerAcknowledgesNothing) {
  CanBus bus;
  Station lone(bus);
  Station listener(bus, rate, Controller::Mode::listen_only);
  bus.run_for(milliseconds(1));
  lone.node.send(document_frame);
  // 15 attempts: the sender's flag destroys the frame for the listener as well.
  while (lone.transmit_errors() < 120) {
    bus.run_for(bit);
  }
  bus.run_for(bit * 20);
  EXPECT_EQ(listener.received, Texts{});
  bus.run_for(milliseconds(100));
  EXPECT_EQ(lone.sent, Texts{});
  EXPECT_EQ(lone.transmit_errors(), 128U);
  // A passive flag leaves the wire recessive as an end of frame does, and receivers do not look at
  // the acknowledgement: the listener takes each further attempt for a frame.
  EXPECT_EQ(listener.received.size(), bus.statistics().transmit_errors - 16);
  EXPECT_EQ(listener.transmit_errors() + listener.receive_errors(), 0U);
}

TEST(CanBus, AListenerHearsWhatOthersAcknowledge) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  Station listener(bus, rate, Controller::Mode::listen_only);
  listener.node.send(extended(0));
  send_without_end(sender, document_frame);
  bus.run_for(milliseconds(100));
  EXPECT_EQ(listener.received.size(), receiver.received.size());
  EXPECT_GT(listener.received.size(), 500U);
  EXPECT_EQ(listener.sent, Texts{});
}

}  // namespace
}  // namespace roio::sim
