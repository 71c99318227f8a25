// The worked examples of docs/protocol.md, each cell of each row.
#include "vectors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <iomanip>
#include <roio/filter_mcp2515.hpp>
#include <roio/frame_length.hpp>
#include <set>
#include <sstream>

namespace roio {
namespace {

std::vector<test::Vector> vectors() {
  return test::read_vectors(ROIO_PROTOCOL_DOCUMENT);
}

std::string candump_text(const Frame& frame) {
  std::ostringstream text;
  text << std::uppercase << std::hex << std::setfill('0') << std::setw(8) << frame.id << '#';
  for (std::uint8_t i = 0; i < frame.length; ++i) {
    text << std::setw(2) << static_cast<int>(frame.data[i]);
  }
  return text.str();
}

class WorkedExample : public testing::TestWithParam<test::Vector> {};

TEST_P(WorkedExample, MessageToFrame) {
  Frame frame{};
  ASSERT_EQ(to_frame(GetParam().message, frame), Status::ok);
  EXPECT_EQ(frame.id, GetParam().id);
  EXPECT_EQ(frame.kind, FrameKind::extended);
  EXPECT_EQ(frame.length, GetParam().message.length);
  EXPECT_EQ(candump_text(frame), GetParam().text);
}

TEST_P(WorkedExample, FrameToMessage) {
  const Message& expected = GetParam().message;
  Frame frame{GetParam().id, FrameKind::extended, expected.length, {}};
  std::copy(std::begin(expected.data), std::end(expected.data), frame.data);
  Message message{};
  ASSERT_EQ(to_message(frame, message), Status::ok);
  EXPECT_EQ(message.header, expected.header);
  EXPECT_EQ(message.length, expected.length);
  EXPECT_TRUE(std::equal(std::begin(expected.data), std::end(expected.data), message.data));
}

TEST_P(WorkedExample, LengthAndCrcOnTheWire) {
  Frame frame{};
  ASSERT_EQ(to_frame(GetParam().message, frame), Status::ok);
  EXPECT_EQ(wire_bits(frame), GetParam().bits);
  EXPECT_EQ(wire_crc(frame), GetParam().crc);
}

TEST_P(WorkedExample, Registers) {
  std::array<std::uint8_t, 4> registers{};
  to_mcp2515_registers(GetParam().id, registers.data());
  registers[1] = static_cast<std::uint8_t>(registers[1] | Mcp2515Filters::exide);
  EXPECT_EQ(registers, GetParam().registers);
  EXPECT_EQ(from_mcp2515_registers(GetParam().registers.data()), GetParam().id);
}

INSTANTIATE_TEST_SUITE_P(
    Protocol, WorkedExample, testing::ValuesIn(vectors()), [](const auto& instance) {
      std::string name = instance.param.name;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

TEST(WorkedExamples, HaveEveryLengthPriorityAndClass) {
  std::set<int> lengths;
  std::set<Priority> priorities;
  std::set<MessageClass> classes;
  for (const test::Vector& vector : vectors()) {
    lengths.insert(vector.message.length);
    priorities.insert(vector.message.header.priority);
    classes.insert(vector.message.header.message_class);
  }
  EXPECT_EQ(lengths, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(priorities.size(), 2U);
  EXPECT_EQ(classes.size(), 3U);
}

}  // namespace
}  // namespace roio
