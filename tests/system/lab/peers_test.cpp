// Other people's programs on the same interface: can-utils and python-can, in both directions.
#include <gtest/gtest.h>

#include <chrono>
#include <roio.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lab_support.hpp"

namespace roio::lab {
namespace {

using PeersTest = LabTest;

struct FrameRow {
  std::string_view why;
  std::string text;  // cansend's argument, and what candump -L prints of it
  Frame frame;
};

const std::vector<FrameRow>& frame_rows() {
  static const std::vector<FrameRow> rows = {
      {"standard, no data", "123#", {0x123, FrameKind::standard, 0, {}}},
      {"lowest identifier", "000#01", {0, FrameKind::standard, 1, {1}}},
      {"highest standard", "7FF#1122", {0x7FF, FrameKind::standard, 2, {0x11, 0x22}}},
      {"a Roio message", "1004A00A#5A2D00", {0x1004A00A, FrameKind::extended, 3, {0x5A, 0x2D, 0}}},
      {"small extended", "00000123#FF", {0x123, FrameKind::extended, 1, {0xFF}}},
      {"highest extended, 8 bytes",
       "1FFFFFFF#0102030405060708",
       {0x1FFFFFFF, FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 8}}},
      {"remote", "123#R", {0x123, FrameKind::standard_remote, 0, {}}},
      {"remote asking for 8", "123#R8", {0x123, FrameKind::standard_remote, 8, {}}},
      {"extended remote", "1004A00A#R4", {0x1004A00A, FrameKind::extended_remote, 4, {}}},
  };
  return rows;
}

void expect_equal(const Frame& actual, const Frame& expected, std::string_view why) {
  EXPECT_EQ(actual.id, expected.id) << why;
  EXPECT_EQ(actual.kind, expected.kind) << why;
  EXPECT_EQ(actual.length, expected.length) << why;
  EXPECT_EQ(std::vector<int>(actual.data, actual.data + max_data_length),
            std::vector<int>(expected.data, expected.data + max_data_length))
      << why;
}

TEST_F(PeersTest, WhatCansendSendsWeDecode) {
  const auto bus = open("vcan0");
  for (const FrameRow& row : frame_rows()) {
    shell("cansend vcan0 " + row.text);
    const auto received = receive_exactly(*bus, 1);
    ASSERT_EQ(received.size(), 1U) << row.why;
    expect_equal(received[0].frame, row.frame, row.why);
    EXPECT_EQ(received[0].lost_before, 0U);
  }
}

TEST_F(PeersTest, WhatWeSendCandumpPrints) {
  Peer candump("candump -L -n " + std::to_string(frame_rows().size()) +
               " vcan0 | sed 's/^([0-9.]*) //'");
  ASSERT_TRUE(eventually([] { return listeners("vcan0") == 1; }));
  const auto bus = open("vcan0");
  std::string expected;
  std::vector<Frame> frames;
  for (const FrameRow& row : frame_rows()) {
    frames.push_back(row.frame);
    expected += "vcan0 " + row.text + "\n";
  }
  const Transfer sent = bus->send(frames, patience);
  EXPECT_EQ(sent.result, Result::ok);
  EXPECT_EQ(sent.count, frames.size());
  EXPECT_EQ(candump.wait(), 0);
  EXPECT_EQ(candump.output(), expected);
}

// Both see the same frames with the kernel's same time stamps, so the logs are equal to the byte.
TEST_F(PeersTest, CangensFramesAndTimesAreCandumps) {
  constexpr std::size_t count = 200;  // fewer than candump's queue holds
  const auto bus = open("vcan0");
  Peer candump("candump -L -n 400 vcan0");
  ASSERT_TRUE(eventually([] { return listeners("vcan0") == 2; }));
  const Timestamp before = std::chrono::system_clock::now();
  shell(
      "cangen vcan0 -g 0 -n 200 && cangen vcan0 -e -R -g 0 -n 100 && cangen vcan0 -e -g 0 -n 100");
  const auto received = receive_exactly(*bus, 2 * count);
  const Timestamp after = std::chrono::system_clock::now();

  std::string log;
  for (const Received& one : received) {
    EXPECT_GE(one.time, before);
    EXPECT_LE(one.time, after);
    std::array<char, max_log_line> line;
    log.append(line.data(), format_log_line(line, one.time, "vcan0", one.frame));
  }
  EXPECT_EQ(candump.wait(), 0);
  EXPECT_EQ(candump.output(), log);
}

TEST_F(PeersTest, ReceivesFromPythonCanWhatItSends) {
  const auto bus = open("vcan0");
  std::string arguments;
  std::vector<std::string> expected;
  for (const FrameRow& row : frame_rows()) {
    arguments += " " + row.text;
    expected.push_back(row.text);
  }
  shell("/usr/bin/python3 " ROIO_LAB_TESTS "/python_peer.py send vcan0" + arguments);
  EXPECT_EQ(texts(receive_exactly(*bus, expected.size())), expected);
}

TEST_F(PeersTest, PythonCanReceivesWhatWeSend) {
  const std::string count = std::to_string(frame_rows().size());
  Peer python("/usr/bin/python3 " ROIO_LAB_TESTS "/python_peer.py receive vcan0 " + count);
  ASSERT_TRUE(eventually([] { return listeners("vcan0") == 1; }));
  const auto bus = open("vcan0");
  std::string expected;
  for (const FrameRow& row : frame_rows()) {
    EXPECT_EQ(bus->send(row.frame), Result::ok) << row.why;
    expected += row.text + "\n";
  }
  EXPECT_EQ(python.wait(), 0);
  EXPECT_EQ(python.output(), expected);
}

TEST_F(PeersTest, OwnFramesComeToTheNeighbourAndNotToUs) {
  const auto bus = open("vcan0");
  const auto neighbour = open("vcan0");
  const auto frames = numbered_frames(7, 100);  // several batches
  ASSERT_EQ(bus->send(frames, patience).result, Result::ok);
  EXPECT_EQ(texts(receive_exactly(*neighbour, frames.size())), texts(frames));
  EXPECT_TRUE(receive_all(*bus).empty());
  EXPECT_EQ(bus->statistics().sent, frames.size());
  EXPECT_EQ(neighbour->statistics().received, frames.size());
}

}  // namespace
}  // namespace roio::lab
