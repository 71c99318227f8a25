// The SocketCAN bus on a made-up kernel: errors at chosen moments, and threads under the
// sanitizers. What a real kernel does is tests/system/lab's.
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <roio.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "fake_kernel.hpp"

namespace roio {
namespace {

constexpr Timeout patience = std::chrono::seconds(20);  // a guard against hanging, never a measure

class SocketCanBus : public testing::Test {
 protected:
  void SetUp() override { kernel_.set_interface("can0", {}); }

  FakeKernel kernel_;
};

std::vector<Frame> frames(std::size_t count) {
  std::vector<Frame> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    result[i] = Frame{static_cast<std::uint32_t>(i), FrameKind::extended, 1, {7}};
  }
  return result;
}

can_frame raw(std::uint32_t id) {
  can_frame frame{};
  frame.can_id = id;
  return frame;
}

/// The code and the whole text of what open() throws.
std::system_error refusal(const std::string& name) {
  try {
    open(name);
  } catch (const std::system_error& error) {
    return error;
  }
  ADD_FAILURE() << name << " was opened";
  return std::system_error(std::error_code{});
}

void expect_sent(FakeKernel& kernel, const std::vector<Frame>& expected) {
  for (const Frame& frame : expected) {
    ASSERT_EQ(kernel.get().can_id, tagged_id(frame));
  }
}

TEST_F(SocketCanBus, ARefusedSocketIsExplained) {
  struct Row {
    int error;
    std::error_code code;
    std::string text;
  };
  const std::string no_can =
      "can0: this kernel has no CAN; try `modprobe can_raw`, or local:NAME, which needs none";
  const std::vector<Row> rows = {
      {EAFNOSUPPORT, Errc::no_can_support, no_can},
      {EPROTONOSUPPORT, Errc::no_can_support, no_can},
      {EPERM, {EPERM, std::generic_category()}, "can0: Operation not permitted"},
      {EMFILE, {EMFILE, std::generic_category()}, "can0: Too many open files"},
  };
  for (const Row& row : rows) {
    kernel_.refuse_sockets(row.error);
    const std::system_error error = refusal("can0");
    EXPECT_EQ(error.code(), row.code);
    EXPECT_EQ(error.what(), row.text);
  }
}

TEST_F(SocketCanBus, WrongInterfacesAreNamed) {
  kernel_.set_interface("eth0", {.index = 2, .is_can = false});
  EXPECT_EQ(refusal("can1").code(), make_error_code(Errc::no_such_interface));
  EXPECT_EQ(refusal("eth0").code(), make_error_code(Errc::not_a_can_interface));
}

// What a batch of 10 meets on its way, and that it all goes, in order, by the deadline.
TEST_F(SocketCanBus, SendGoesOnAfterEveryObstacle) {
  struct Row {
    std::string_view why;
    std::vector<FakeAnswer> answers;
    std::uint64_t waits;
  };
  const std::vector<Row> rows = {
      {"nothing in the way", {}, 0},
      {"parts of the batch", {{0, 3}, {0, 1}, {0, 2}}, 0},
      {"a signal", {{EINTR}}, 0},
      {"queue full once", {{ENOBUFS}}, 1},
      {"one wait in several pauses", {{ENOBUFS}, {ENOBUFS}, {ENOBUFS}, {ENOBUFS}}, 1},
      {"two waits, some frames between", {{0, 4}, {ENOBUFS}, {0, 1}, {ENOBUFS}, {ENOBUFS}}, 2},
      {"socket full", {{0, 4}, {EAGAIN}}, 1},
      {"an outage that is over", {{ENETDOWN}, {0, 2}, {ENODEV}, {ENXIO}}, 0},
  };
  for (const Row& row : rows) {
    const auto bus = open("can0");
    kernel_.answer_sends_with(row.answers);
    const Transfer sent = bus->send(frames(10), patience);
    EXPECT_EQ(sent.result, Result::ok) << row.why;
    EXPECT_EQ(sent.count, 10U) << row.why;
    expect_sent(kernel_, frames(10));
    EXPECT_EQ(bus->statistics().sent, 10U) << row.why;
    EXPECT_EQ(bus->statistics().send_waits, row.waits) << row.why;
    EXPECT_EQ(bus->statistics().send_timeouts, 0U) << row.why;
  }
}

TEST_F(SocketCanBus, AFullQueueEndsACallThatMayNotWait) {
  const auto bus = open("can0");
  kernel_.answer_sends_with({{0, 4}, {ENOBUFS}, {ENOBUFS}});
  const Transfer sent = bus->send(frames(10), no_wait);
  EXPECT_EQ(sent.result, Result::timeout);
  EXPECT_EQ(sent.count, 4U);
  EXPECT_EQ(bus->statistics().sent, 4U);
  EXPECT_EQ(bus->statistics().send_timeouts, 1U);
  EXPECT_EQ(bus->statistics().send_waits, 0U) << "it did not wait";
}

TEST_F(SocketCanBus, AQueueThatStaysFullEndsACallAtItsDeadline) {
  const auto bus = open("can0");
  // So many are asked for only by somebody who does not wait in between, from the first frame on.
  kernel_.answer_sends_with(std::vector<FakeAnswer>(1000, FakeAnswer{ENOBUFS}));
  EXPECT_EQ(bus->send(frames(1)[0], std::chrono::milliseconds(30)), Result::timeout);
  EXPECT_EQ(bus->statistics().send_waits, 1U);
  EXPECT_EQ(bus->statistics().send_timeouts, 1U);
}

// A process may find its deadline past before it has begun to wait: with a nanosecond it always
// does.
TEST_F(SocketCanBus, AWaitIsCountedHoweverLateTheProcessIs) {
  const auto bus = open("can0");
  kernel_.answer_sends_with({{ENOBUFS}, {ENOBUFS}, {ENOBUFS}});
  EXPECT_EQ(bus->send(frames(1)[0], std::chrono::nanoseconds(1)), Result::timeout);
  EXPECT_EQ(bus->statistics().send_waits, 1U);
  EXPECT_EQ(bus->statistics().send_timeouts, 1U);
}

TEST_F(SocketCanBus, ErrorsThatShouldNotBeAreThrownWithTheInterfacesName) {
  const auto bus = open("can0");
  kernel_.answer_sends_with({{EPERM}});
  try {
    static_cast<void>(bus->send(frames(1)[0], patience));
    FAIL() << "nothing was thrown";
  } catch (const std::system_error& error) {
    EXPECT_STREQ(error.what(), "can0: Operation not permitted");
  }
  kernel_.answer_receives_with({{EBADF}});
  Received received{};
  try {
    static_cast<void>(bus->receive(received, no_wait));
    FAIL() << "nothing was thrown";
  } catch (const std::system_error& error) {
    EXPECT_STREQ(error.what(), "can0: Bad file descriptor");
  }
}

TEST_F(SocketCanBus, NothingOfABatchWithABadFrameIsSent) {
  const auto bus = open("can0");
  auto batch = frames(3);
  batch[2].length = 9;
  try {
    static_cast<void>(bus->send(batch, patience));
    FAIL() << "nothing was thrown";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(Errc::bad_frame));
  }
  EXPECT_EQ(bus->statistics().sent, 0U);
}

TEST_F(SocketCanBus, ReceiveGoesOnAfterOutagesAndSignals) {
  const auto bus = open("can0");
  kernel_.put(raw(1));
  kernel_.answer_receives_with({{EINTR}, {ENETDOWN}, {ENODEV}, {EAGAIN}});
  Received received{};
  EXPECT_EQ(bus->receive(received, patience), Result::ok);
  EXPECT_EQ(received.frame.id, 1U);
  EXPECT_GE(bus->statistics().outages, 1U);
  EXPECT_EQ(bus->state(), BusState::active);
}

// As error reports and news of other interfaces do when there are many: poll() always says that
// there is something, and there is nothing to return.
TEST_F(SocketCanBus, WakingForNothingKeepsNoCallBeyondItsDeadline) {
  const auto bus = open("can0");
  const std::vector<FakeAnswer> nothing(1000000, FakeAnswer{EAGAIN});
  kernel_.put(raw(1));
  kernel_.answer_receives_with(nothing);
  Received received{};
  EXPECT_EQ(bus->receive(received, no_wait), Result::timeout);
  EXPECT_EQ(bus->receive(received, std::chrono::milliseconds(10)), Result::timeout);
  bus->cancel();
  EXPECT_EQ(bus->receive(received, forever), Result::cancelled);
  bus->resume();
  kernel_.answer_receives_with({});
  EXPECT_EQ(bus->receive(received, no_wait), Result::ok);

  kernel_.answer_sends_with(nothing);
  EXPECT_EQ(bus->send(frames(1)[0], no_wait), Result::timeout);
  EXPECT_EQ(bus->send(frames(1)[0], std::chrono::milliseconds(10)), Result::timeout);
  bus->cancel();
  EXPECT_EQ(bus->send(frames(1)[0], forever), Result::cancelled);
}

TEST_F(SocketCanBus, BatchesLargerThanOneSystemCall) {
  const auto bus = open("can0");
  const auto before = std::chrono::system_clock::now();
  std::thread sender([&] {
    for (const Frame& frame : frames(300)) {
      kernel_.put(raw(tagged_id(frame)));
    }
  });
  std::vector<Received> received(300);
  std::size_t count = 0;
  while (count < received.size()) {
    const Transfer transfer = bus->receive(std::span(received).subspan(count), patience);
    ASSERT_EQ(transfer.result, Result::ok);
    count += transfer.count;
  }
  sender.join();
  for (std::size_t i = 0; i < received.size(); ++i) {
    EXPECT_EQ(received[i].frame.id, i);
    EXPECT_GE(received[i].time, before);
    EXPECT_LE(received[i].time, std::chrono::system_clock::now());
  }
}

TEST_F(SocketCanBus, CanFdFramesAreCountedAndNotReturned) {
  const auto bus = open("can0");
  canfd_frame fd{};
  fd.can_id = 0x123;
  fd.len = 8;  // as a classic frame's could be
  kernel_.put(raw(1));
  kernel_.put(fd);
  fd.len = CANFD_MAX_DLEN;
  kernel_.put(fd);
  kernel_.put(raw(2));
  std::array<Received, 4> received{};
  const Transfer transfer = bus->receive(received, patience);
  ASSERT_EQ(transfer.count, 2U);
  EXPECT_EQ(received[0].frame.id, 1U);
  EXPECT_EQ(received[1].frame.id, 2U);
  EXPECT_EQ(received[1].lost_before, 0U);
  EXPECT_EQ(bus->statistics().received, 2U);
  EXPECT_EQ(bus->statistics().fd_frames, 2U);
  // Alone, they end no wait.
  kernel_.put(fd);
  EXPECT_EQ(bus->receive(received, no_wait).result, Result::timeout);
  EXPECT_EQ(bus->statistics().fd_frames, 3U);
}

TEST_F(SocketCanBus, TheDropCountOutlivesTheKernels32Bits) {
  const auto bus = open("can0");
  for (const std::uint32_t drops : {0xFFFFFFF0U, 0x10U, 0x20U}) {
    kernel_.set_drops(drops);
    static_cast<void>(bus->statistics());
  }
  EXPECT_EQ(bus->statistics().dropped, (std::uint64_t{1} << 32) + 0x20);
}

TEST_F(SocketCanBus, ACarrierThatIsBackMeansARestartThoughItsReportWasLost) {
  const auto bus = open("can0", {.send_only = true});
  kernel_.put(raw(CAN_ERR_FLAG | CAN_ERR_BUSOFF));
  Received received{};
  EXPECT_EQ(bus->receive(received, no_wait), Result::timeout);
  EXPECT_EQ(bus->state(), BusState::bus_off);
  kernel_.set_interface("can0", {.carrier = false});
  EXPECT_EQ(bus->state(), BusState::bus_off);
  kernel_.set_interface("can0", {});
  EXPECT_EQ(bus->state(), BusState::active);
  EXPECT_EQ(bus->statistics().outages, 0U);
}

TEST_F(SocketCanBus, AnotherIndexUnderTheSameNameIsBoundTo) {
  const auto bus = open("can0");
  kernel_.remove_interface("can0");
  EXPECT_EQ(bus->state(), BusState::absent);
  kernel_.set_interface("can0", {.index = 5, .up = false});
  EXPECT_EQ(bus->state(), BusState::down);
  kernel_.set_interface("can0", {.index = 5});
  EXPECT_EQ(bus->send(frames(1)[0], patience), Result::ok);
  EXPECT_EQ(bus->statistics().outages, 1U);
  kernel_.remove_interface("can0");
  kernel_.set_interface("can0", {.index = 6, .is_can = false});
  EXPECT_EQ(bus->state(), BusState::absent) << "something else took the name";
}

// One sender, one receiver, and everything that any thread may call meanwhile.
TEST_F(SocketCanBus, ThreadsAsTheContractAllows) {
  constexpr std::size_t count = 3000;
  const auto bus = open("can0");
  std::atomic<bool> done{false};

  std::thread sender([&] {
    for (std::size_t sent = 0; sent < count;) {
      const auto batch = frames(50);
      const Transfer transfer = bus->send(batch, patience);
      ASSERT_TRUE(transfer.result == Result::ok || transfer.result == Result::cancelled);
      sent += transfer.count;
    }
  });
  std::thread wire_out([&] {
    for (std::size_t i = 0; i < count; ++i) {
      static_cast<void>(kernel_.get());
    }
  });
  std::thread wire_in([&] {
    for (std::size_t i = 0; i < count; ++i) {
      kernel_.put(raw(i % 100 == 0 ? CAN_ERR_FLAG | CAN_ERR_CRTL : 0x123));
    }
  });
  std::thread receiver([&] {
    std::array<Received, 20> batch;
    for (std::size_t received = 0; received < count - count / 100;) {
      const Transfer transfer = bus->receive(batch, patience);
      ASSERT_TRUE(transfer.result == Result::ok || transfer.result == Result::cancelled);
      received += transfer.count;
    }
  });
  std::thread others([&] {
    while (!done) {
      static_cast<void>(bus->state());
      static_cast<void>(bus->statistics());
      bus->set_filters(std::array{SocketCanFilter{0, 0}});
      bus->cancel();
      bus->resume();
    }
  });
  std::thread interfaces([&] {
    for (int i = 0; i < 20; ++i) {
      kernel_.set_interface("can0", {.up = false});
      kernel_.remove_interface("can0");
      kernel_.set_interface("can0", {.index = 2 + i});
    }
  });
  for (std::thread* thread : {&sender, &wire_out, &wire_in, &receiver, &interfaces}) {
    thread->join();
  }
  done = true;
  others.join();
  EXPECT_EQ(bus->statistics().received, count - count / 100);
  EXPECT_EQ(bus->statistics().error_frames, count / 100);
  // The last batch may go past what was asked for only by whole frames that were sent.
  EXPECT_GE(bus->statistics().sent, count);
}

TEST_F(SocketCanBus, CloseEndsBothWaits) {
  const auto bus = open("can0");
  kernel_.set_interface("can0", {.up = false});
  std::thread sender([&] { EXPECT_EQ(bus->send(frames(1)[0], forever), Result::closed); });
  std::thread receiver([&] {
    Received received{};
    EXPECT_EQ(bus->receive(received, forever), Result::closed);
  });
  bus->close();
  sender.join();
  receiver.join();
  kernel_.set_interface("can0", {});
  EXPECT_EQ(bus->send(frames(1)[0], no_wait), Result::closed) << "though there is room";
}

}  // namespace
}  // namespace roio
