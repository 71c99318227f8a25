// Opening, refusals and filters on the real kernel.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <roio.hpp>
#include <string>
#include <thread>
#include <vector>

#include "lab_support.hpp"

namespace roio::lab {
namespace {

using OpenTest = LabTest;
using FilterTest = LabTest;
using WaitTest = LabTest;

std::string refusal(const std::string& url, Errc expected) {
  try {
    open(url);
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(expected)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << url << " was opened";
  return {};
}

TEST_F(OpenTest, AMissingInterfaceIsNamed) {
  EXPECT_EQ(refusal("can77", Errc::no_such_interface),
            "can77: no such network interface; `ip link` lists them, and local:NAME needs none");
}

TEST_F(OpenTest, AnInterfaceThatIsNotCanIsNamed) {
  EXPECT_EQ(refusal("lo", Errc::not_a_can_interface),
            "lo: not a CAN interface; `ip link show type can` lists those, and local:NAME needs "
            "none");
}

TEST_F(OpenTest, TheNameIsTheInterfaces) {
  EXPECT_EQ(open("vcan0")->name(), "vcan0");
  EXPECT_EQ(open("socketcan:vcan0")->name(), "vcan0");
}

TEST_F(FilterTest, TheKernelHasThem) {
  const auto bus = open("vcan0");
  EXPECT_EQ(listeners("vcan0"), 1) << "all frames at first";
  bus->set_filters(std::array{SocketCanFilter{0x9004A00A, 0xDFFFFFF0}});
  EXPECT_EQ(listeners("vcan0"), 0);
  const std::string list = shell("grep vcan0 /proc/net/can/rcvlist_fil");
  EXPECT_NE(list.find("9004a00"), std::string::npos) << list;
  EXPECT_NE(list.find("dffffff0"), std::string::npos) << list;
}

TEST_F(FilterTest, EachPassesWhatItSays) {
  struct Row {
    std::string why;
    std::vector<SocketCanFilter> filters;
    std::vector<std::string> passed;
  };
  const std::string sent =
      "for f in 123# 124# 00000123# 123#R; do cansend vcan0 $f || exit 1; done";
  const std::vector<Row> rows = {
      {"everything", {{0, 0}}, {"123#", "124#", "00000123#", "123#R"}},
      {"none", {}, {}},
      {"identifier alone, any kind", {{0x123, 0x7FF}}, {"123#", "00000123#", "123#R"}},
      {"standard data", {{0x123, 0xC00007FF}}, {"123#"}},
      {"extended data", {{0x80000123, 0xDFFFFFFF}}, {"00000123#"}},
      {"two that overlap pass a frame once",
       {{0x123, 0xC00007FF}, {0x120, 0xC00007F8}},
       {"123#", "124#"}},
      {"inverted", {{0x20000123, 0x7FF}}, {"124#"}},
  };
  for (const Row& row : rows) {
    const auto bus = open("vcan0");
    bus->set_filters(row.filters);
    shell(sent);
    EXPECT_EQ(texts(receive_all(*bus)), row.passed) << row.why;
    EXPECT_EQ(bus->statistics().dropped, 0U) << row.why;
  }
}

TEST_F(FilterTest, FiveHundredAndTwelveAndNotOneMore) {
  const auto bus = open("vcan0");
  std::vector<SocketCanFilter> filters(512, SocketCanFilter{0x7FF, 0xC00007FF});
  filters.back() = {0x123, 0xC00007FF};
  bus->set_filters(filters);
  filters.insert(filters.begin(), SocketCanFilter{0, 0});
  try {
    bus->set_filters(filters);
    FAIL() << "513 filters were taken";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(Errc::too_many_filters));
    EXPECT_STREQ(error.what(), "vcan0: 513: too many filters; a bus takes 512");
  }
  shell("cansend vcan0 124#; cansend vcan0 123#");
  EXPECT_EQ(texts(receive_all(*bus)), std::vector<std::string>{"123#"}) << "as they were";
}

TEST_F(FilterTest, SendOnlyReceivesNothingUntilFiltersAreSet) {
  const auto bus = open("vcan0", {.send_only = true});
  shell("cansend vcan0 123#01");
  EXPECT_TRUE(receive_all(*bus).empty());
  bus->set_filters(std::array{SocketCanFilter{0, 0}});
  shell("cansend vcan0 123#02");
  EXPECT_EQ(texts(receive_all(*bus)), std::vector<std::string>{"123#02"});
}

TEST_F(FilterTest, ANodesProgramIsTheKernels) {
  Node node(open("vcan0"), Address{0, 2});
  // To 0.2, to 0.3, to 0.* and a standard frame: two are for the node.
  shell("cansend vcan0 1000400A#01; cansend vcan0 1000600A#02");
  shell("cansend vcan0 101FE00A#03; cansend vcan0 123#04");
  std::vector<int> got;
  ReceivedMessage message{};
  while (node.receive(message, a_moment) == Result::ok) {
    got.push_back(message.message.data[0]);
  }
  EXPECT_EQ(got, (std::vector<int>{1, 3}));
  EXPECT_EQ(node.bus().statistics().received, 2U) << "the kernel kept the others away";
}

Bus* bus_of_the_signal = nullptr;

TEST_F(WaitTest, ASignalHandlerMayCancel) {
  const auto bus = open("vcan0");
  bus_of_the_signal = bus.get();
  struct sigaction action {};
  action.sa_handler = [](int) { bus_of_the_signal->cancel(); };
  struct sigaction before {};
  ASSERT_EQ(::sigaction(SIGALRM, &action, &before), 0);
  ::alarm(1);
  Received received{};
  EXPECT_EQ(bus->receive(received, forever), Result::cancelled);
  ::sigaction(SIGALRM, &before, nullptr);
}

TEST_F(WaitTest, ASignalThatDoesNotCancelDoesNotEndAWait) {
  const auto bus = open("vcan0");
  struct sigaction action {};
  action.sa_handler = [](int) {};
  struct sigaction before {};
  ASSERT_EQ(::sigaction(SIGALRM, &action, &before), 0);
  ::alarm(1);
  Received received{};
  Peer cansend("sleep 1.2; cansend vcan0 123#");
  EXPECT_EQ(bus->receive(received, patience), Result::ok);
  ::sigaction(SIGALRM, &before, nullptr);
}

TEST_F(WaitTest, SendsAndReceivesAtTheSameTimeAndIsLookedAtMeanwhile) {
  constexpr std::size_t count = 2000;
  const auto left = open("vcan0");
  const auto right = open("vcan0");
  const auto exchange = [](Bus& bus, std::uint32_t first) {
    return std::thread([&bus, first] {
      const auto frames = numbered_frames(first, count);
      for (const Frame& one : frames) {
        EXPECT_EQ(bus.send(one, patience), Result::ok);
      }
    });
  };
  std::thread from_left = exchange(*left, 0);
  std::thread from_right = exchange(*right, 0x10000);
  std::thread looker([&] {
    for (int i = 0; i < 50; ++i) {
      EXPECT_EQ(left->state(), BusState::active);
      EXPECT_EQ(left->statistics().dropped, 0U);
    }
  });
  const auto at_left = receive_exactly(*left, count);
  from_left.join();
  from_right.join();
  looker.join();
  EXPECT_EQ(texts(at_left), texts(numbered_frames(0x10000, count)));
  EXPECT_EQ(texts(receive_exactly(*right, count)), texts(numbered_frames(0, count)));
}

}  // namespace
}  // namespace roio::lab
