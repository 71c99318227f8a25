// The kinds and the robot that come with Roio: they are read, and mean what the sketches do.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <roio/robot.hpp>
#include <roio/robot_json.hpp>

#include "folder.hpp"
#include "parsing.hpp"
#include "robot/robot_reader.hpp"

namespace roio {
namespace {

using test::source_dir;
using test::verdict;

std::string hex(const Parsed<Message>& message) {
  return message ? to_hex(message->data, message->length) : message.error().message;
}

Message message_from(Address source, Address destination, std::string_view data) {
  const Bytes bytes = *parse_hex(data);
  Message message{};
  message.header = {Priority::normal, MessageClass::message, destination, source};
  message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), message.data);
  return message;
}

std::string shown(const std::optional<NamedMessage>& message) {
  if (!message) {
    return "bytes";
  }
  std::string out = message->kind->name;
  for (const Reading& reading : message->readings) {
    out += ' ' + reading.field->name + '=' + reading.text() + reading.field->unit;
  }
  return out;
}

TEST(Shipped, KindsAreRead) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir / "kinds")) {
    EXPECT_EQ(verdict(load_kind(entry.path())), "ok");
    ++count;
  }
  EXPECT_EQ(count, 4);
}

/// What docs/robot-file.md shows, the second time with the kinds beside it that it names.
TEST(Shipped, TheDocumentsExamples) {
  std::ifstream file(source_dir / "docs" / "robot-file.md");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::vector<std::string> blocks;
  for (std::size_t at = 0; (at = text.find("\n```json\n", at)) != std::string::npos;) {
    at += 9;
    blocks.push_back(text.substr(at, text.find("\n```", at) - at));
  }
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_EQ(verdict(parse_kind(blocks[0], "document")), "ok");
  EXPECT_EQ(verdict(robot_file::parse_robot(blocks[1], source_dir / "robot.json", {})), "ok");
  const auto arm = load_robot(source_dir / "examples" / "arm-robot" / "robot.json");
  EXPECT_EQ(verdict(parse_json(blocks[2], *arm)), "ok");
}

TEST(Shipped, ArmRobot) {
  const auto robot = load_robot(source_dir / "examples" / "arm-robot" / "robot.json");
  ASSERT_EQ(verdict(robot), "ok");
  EXPECT_EQ(hex(robot->encode("arm", "angles", {{"shoulder", 90}, {"elbow", 45}, {"hand", 0}})),
            "5A2D00");
  EXPECT_EQ(hex(robot->encode("arm", "refusals", {})), "");
  EXPECT_EQ(shown(robot->decode(message_from({0, 10}, {0, 2}, "5A2D00"))),
            "angles shoulder=90deg elbow=45deg hand=0deg");
  EXPECT_EQ(shown(robot->decode(message_from({0, 2}, {0, 10}, "0102"))), "refusals count=258");
  EXPECT_EQ(shown(robot->decode(message_from({0, 3}, {0, 10}, "640105FF0080"))),
            "values light=100 button1=1 button2=5 pot1=255 pot2=0 pot3=128");
  EXPECT_EQ(shown(robot->decode(message_from({0, 10}, {0, 3}, "01"))), "bytes");
}

}  // namespace
}  // namespace roio
