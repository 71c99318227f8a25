// The controller's error reports, injected into vcan0 as the frames that a driver makes.
#include <gtest/gtest.h>

#include <roio.hpp>
#include <string>
#include <thread>

#include "lab_support.hpp"

namespace roio::lab {
namespace {

using ControllerTest = LabTest;

// Bit 29 of the identifier is CAN_ERR_FLAG; then the class, and data[1] for controller problems.
const std::string warning = "20000004#0008000000000000";
const std::string passive = "20000004#0020000000000000";
const std::string active_again = "20000004#0040000000000000";
const std::string overrun = "20000004#0001000000000000";
const std::string bus_off = "20000040#0000000000000000";
const std::string restarted = "20000100#0000000000000000";

void inject(Bus& bus, const std::string& report) {
  const std::uint64_t before = bus.statistics().error_frames;
  shell("cansend vcan0 " + report);
  EXPECT_TRUE(eventually([&] {
    Received received{};
    EXPECT_EQ(bus.receive(received, no_wait), Result::timeout) << "not asked for";
    return bus.statistics().error_frames == before + 1;
  })) << report;
}

TEST_F(ControllerTest, ReportsBecomeStateAndCounts) {
  const auto bus = open("vcan0");
  inject(*bus, warning);
  EXPECT_EQ(bus->state(), BusState::warning);
  inject(*bus, passive);
  EXPECT_EQ(bus->state(), BusState::passive);
  inject(*bus, active_again);
  EXPECT_EQ(bus->state(), BusState::active);
  inject(*bus, bus_off);
  EXPECT_EQ(bus->state(), BusState::bus_off);
  EXPECT_EQ(bus->statistics().bus_offs, 1U);
  inject(*bus, restarted);
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(bus->statistics().overruns, 0U);
  inject(*bus, overrun);
  EXPECT_EQ(bus->statistics().overruns, 1U);
  EXPECT_EQ(bus->statistics().error_frames, 6U);
  EXPECT_EQ(bus->statistics().received, 0U) << "reports are no frames of the bus";
  EXPECT_EQ(bus->statistics().bus_offs, 1U);
}

TEST_F(ControllerTest, ReportsComeWhateverTheFiltersAre) {
  const auto bus = open("vcan0", {.send_only = true});
  inject(*bus, passive);
  EXPECT_EQ(bus->state(), BusState::passive);
}

TEST_F(ControllerTest, ReportsAreReturnedToThoseWhoAsk) {
  const auto bus = open("vcan0", {.error_frames = true});
  shell("cansend vcan0 " + warning);
  EXPECT_EQ(texts(receive_exactly(*bus, 1)), std::vector<std::string>{warning});
  EXPECT_EQ(bus->statistics().error_frames, 1U);
  EXPECT_EQ(bus->state(), BusState::warning);
}

TEST_F(ControllerTest, AReceiverGoesOnThroughBusOffAndReadsTheReportMeanwhile) {
  const auto bus = open("vcan0");
  Received received{};
  std::thread receiver([&] { EXPECT_EQ(bus->receive(received, patience), Result::ok); });
  shell("cansend vcan0 " + bus_off);
  EXPECT_TRUE(eventually([&] { return bus->state() == BusState::bus_off; }));
  shell("cansend vcan0 " + restarted);
  EXPECT_TRUE(eventually([&] { return bus->state() == BusState::active; }));
  shell("cansend vcan0 123#");
  receiver.join();
  EXPECT_EQ(to_text(received.frame), "123#");
}

TEST_F(ControllerTest, SendingWaitsForTheRestart) {
  const auto bus = open("vcan0");
  const auto listener = open("vcan0");
  inject(*bus, bus_off);
  EXPECT_EQ(bus->send(frame("123#01"), a_moment), Result::timeout);
  std::thread sender([&] { EXPECT_EQ(bus->send(frame("123#02"), patience), Result::ok); });
  inject(*bus, restarted);
  sender.join();
  EXPECT_EQ(texts(receive_all(*listener)), std::vector<std::string>{"123#02"});
}

TEST_F(ControllerTest, DownAndUpRestartsTheController) {
  const auto bus = open("vcan0");
  inject(*bus, bus_off);
  shell("ip link set vcan0 down; ip link set vcan0 up");
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(bus->send(frame("123#"), no_wait), Result::ok);
}

// vxcan is a pair of which each end has a carrier only while the other one is up: the kernel throws
// away what is sent without, and says that it went. As in bus-off.
TEST_F(ControllerTest, NothingIsSentWithoutACarrier) {
  shell("ip link add vxcan0 type vxcan peer name vxcan1 && ip link set vxcan0 up");
  {
    const auto bus = open("vxcan0");
    EXPECT_EQ(bus->send(frame("123#01"), a_moment), Result::timeout);
    shell("ip link set vxcan1 up");
    const auto listener = open("vxcan1");
    EXPECT_EQ(bus->send(frame("123#02"), patience), Result::ok);
    EXPECT_EQ(texts(receive_exactly(*listener, 1)), std::vector<std::string>{"123#02"});
  }
  shell("ip link del vxcan0");
}

}  // namespace
}  // namespace roio::lab
