// What the SocketCAN bus tells to an event loop, on a made-up kernel: obstacles at chosen moments.
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <array>
#include <cerrno>
#include <roio.hpp>
#include <string>

#include "event_loop.hpp"
#include "fake_kernel.hpp"

namespace roio::test {
namespace {

class SocketCanEvents : public testing::Test {
 protected:
  void SetUp() override { kernel_.set_interface("can0", {}); }

  FakeKernel kernel_;
};

const Frame some_frame{1, FrameKind::extended, 0, {}};

can_frame error_of(std::uint32_t classes) {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | classes;
  frame.can_dlc = CAN_ERR_DLC;
  return frame;
}

/// A program receives when fd() says so.
void receive_nothing(Bus& bus) {
  Received received{};
  EXPECT_EQ(bus.receive(received, no_wait), Result::timeout);
}

TEST_F(SocketCanEvents, RoomIsToldAfterEveryObstacle) {
  for (const int obstacle : {EAGAIN, ENOBUFS}) {
    const auto bus = open("can0");
    kernel_.answer_sends_with({{obstacle}, {obstacle}});
    ASSERT_EQ(bus->send(some_frame, no_wait), Result::timeout);
    EXPECT_EQ(next_events(*bus), (Events{.room = true})) << obstacle;
    expect_no_events(*bus);
    EXPECT_EQ(bus->send(some_frame, no_wait), Result::ok);
    expect_no_events(*bus);
  }
}

TEST_F(SocketCanEvents, WithoutAnInterfaceThereIsNoRoomUntilItIsBack) {
  const auto bus = open("can0");
  kernel_.set_interface("can0", {.up = false});
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->state(), BusState::down);
  ASSERT_EQ(bus->send(some_frame, no_wait), Result::timeout);
  expect_no_events(*bus);
  kernel_.remove_interface("can0");
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->state(), BusState::absent);
  EXPECT_EQ(bus->trouble()->code(), Errc::no_such_interface);
  kernel_.set_interface("can0", {.index = 2});
  EXPECT_EQ(next_events(*bus), (Events{.room = true, .state = true}));
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_FALSE(bus->trouble());
  EXPECT_EQ(bus->send(some_frame, no_wait), Result::ok);
}

TEST_F(SocketCanEvents, TheControllersStateIsToldWithItsReports) {
  const auto bus = open("can0");
  kernel_.put(error_of(CAN_ERR_BUSOFF));
  receive_nothing(*bus);
  EXPECT_EQ(next_events(*bus), (Events{.state = true}));
  EXPECT_EQ(bus->state(), BusState::bus_off);
  ASSERT_EQ(bus->send(some_frame, no_wait), Result::timeout);
  kernel_.put(error_of(CAN_ERR_RESTARTED));
  receive_nothing(*bus);
  EXPECT_EQ(next_events(*bus), (Events{.room = true, .state = true}));
  EXPECT_EQ(bus->state(), BusState::active);
}

TEST_F(SocketCanEvents, FramesThatFoundTheQueueFullAreToldAtItsEnd) {
  const auto bus = open("can0");
  for (int i = 0; i < 2; ++i) {
    can_frame frame{};
    frame.can_id = 1;
    kernel_.put(frame);
  }
  kernel_.set_drops(5);  // behind the last of these: no frame says so
  std::array<Received, 8> received{};
  EXPECT_EQ(bus->receive(received, no_wait).count, 2U);
  EXPECT_EQ(next_events(*bus), (Events{.loss = true}));
  EXPECT_EQ(bus->statistics().dropped, 5U);
  expect_no_events(*bus);
}

TEST_F(SocketCanEvents, AnInterfaceMayComeAfterOpen) {
  const auto bus = open("can7", {.background = true});
  EXPECT_EQ(bus->state(), BusState::absent);
  EXPECT_EQ(bus->trouble()->code(), Errc::no_such_interface);
  EXPECT_STREQ(bus->trouble()->what(), std::system_error(Errc::no_such_interface, "can7").what());
  ASSERT_EQ(bus->send(some_frame, no_wait), Result::timeout);
  kernel_.set_interface("can7", {.index = 7, .is_can = false});
  static_cast<void>(bus->take_events());
  EXPECT_EQ(bus->trouble()->code(), Errc::not_a_can_interface);
  kernel_.set_interface("can7", {.index = 8});
  EXPECT_EQ(next_events(*bus), (Events{.room = true, .state = true}));
  EXPECT_EQ(bus->send(some_frame, no_wait), Result::ok);
  EXPECT_EQ(kernel_.get().can_id, 1U | CAN_EFF_FLAG);
}

TEST_F(SocketCanEvents, AKernelWithoutCanIsNothingToWaitFor) {
  kernel_.refuse_sockets(EAFNOSUPPORT);
  EXPECT_THROW(open("can0", {.background = true}), std::system_error);
}

}  // namespace
}  // namespace roio::test
