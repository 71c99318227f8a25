// Frames to and from the kernel's struct can_frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <roio/frame.hpp>
#include <string_view>
#include <vector>

#include "socketcan/frame.hpp"

namespace roio::socketcan {
namespace {

std::vector<int> bytes(const std::uint8_t* data) {
  return {data, data + max_data_length};
}

can_frame raw(std::uint32_t id, std::uint8_t length) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = length;
  for (std::uint8_t i = 0; i < max_data_length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(0xA0 + i);
  }
  return frame;
}

struct Row {
  std::string_view why;
  std::uint32_t can_id;
  std::uint8_t dlc;
  Frame frame;
};

TEST(SocketCanFrame, FromTheKernel) {
  const std::vector<Row> rows = {
      {"standard", 0x123, 2, {0x123, FrameKind::standard, 2, {0xA0, 0xA1}}},
      {"extended", 0x9FFFFFFF, 1, {0x1FFFFFFF, FrameKind::extended, 1, {0xA0}}},
      {"remote carries no data, whatever the buffer holds",
       0x40000123,
       3,
       {0x123, FrameKind::standard_remote, 3, {}}},
      {"extended remote", 0xC0000123, 0, {0x123, FrameKind::extended_remote, 0, {}}},
      {"error report", 0x20000004, 2, {4, FrameKind::error, 2, {0xA0, 0xA1}}},
      {"error report with other flags too", 0xE0000040, 0, {0x40, FrameKind::error, 0, {}}},
      {"standard with bits that no such identifier has",
       0x1FFFF923,
       0,
       {0x123, FrameKind::standard, 0, {}}},
      {"length of 9 is 8",
       0x123,
       9,
       {0x123, FrameKind::standard, 8, {0xA0, 0xA1, 0xA2, 0xA3, 0xA4, 0xA5, 0xA6, 0xA7}}},
  };
  for (const Row& row : rows) {
    const Frame frame = from_kernel(raw(row.can_id, row.dlc));
    EXPECT_TRUE(is_valid(frame)) << row.why;
    EXPECT_EQ(frame.id, row.frame.id) << row.why;
    EXPECT_EQ(frame.kind, row.frame.kind) << row.why;
    EXPECT_EQ(frame.length, row.frame.length) << row.why;
    EXPECT_EQ(bytes(frame.data), bytes(row.frame.data)) << row.why;
  }
}

TEST(SocketCanFrame, ToTheKernel) {
  struct ToRow {
    std::string_view why;
    Frame frame;
    std::uint32_t can_id;
    std::vector<int> data;
  };
  const std::vector<ToRow> rows = {
      {"extended", {0x123, FrameKind::extended, 2, {1, 2}}, 0x80000123, {1, 2, 0, 0, 0, 0, 0, 0}},
      {"bytes past the length stay here",
       {0x7FF, FrameKind::standard, 1, {1, 2, 3}},
       0x7FF,
       {1, 0, 0, 0, 0, 0, 0, 0}},
      {"remote sends none",
       {0x7FF, FrameKind::standard_remote, 2, {1, 2}},
       0x400007FF,
       {0, 0, 0, 0, 0, 0, 0, 0}},
      {"extended remote",
       {0x1FFFFFFF, FrameKind::extended_remote, 8, {}},
       0xDFFFFFFF,
       {0, 0, 0, 0, 0, 0, 0, 0}},
  };
  for (const ToRow& row : rows) {
    const can_frame frame = to_kernel(row.frame);
    EXPECT_EQ(frame.can_id, row.can_id) << row.why;
    EXPECT_EQ(frame.can_dlc, row.frame.length) << row.why;
    EXPECT_EQ(bytes(frame.data), row.data) << row.why;
  }
}

}  // namespace
}  // namespace roio::socketcan
