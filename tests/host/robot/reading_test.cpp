// Files that are right: what they say is there, field by field.
#include <gtest/gtest.h>

#include <roio/robot.hpp>
#include <string>

#include "folder.hpp"
#include "parsing.hpp"

namespace roio {
namespace {

using test::source_dir;
using test::verdict;

const std::filesystem::path valid = source_dir / "tests/host/robot/valid";

/// A field in one line: its form, where it is, what it holds.
std::string shown(const Field& field) {
  static constexpr const char* forms[] = {"number", "signed", "choice", "bytes"};
  std::string out = field.name + ' ' + forms[static_cast<int>(field.form)] + " at " +
                    std::to_string(field.first_bit) + '+' + std::to_string(field.width) + ", " +
                    std::to_string(field.minimum) + ".." + std::to_string(field.maximum);
  if (field.scale.numerator != 1 || field.scale.denominator != 1) {
    out += " * " + std::to_string(field.scale.numerator) + '/' +
           std::to_string(field.scale.denominator);
  }
  out += field.unit.empty() ? "" : " " + field.unit;
  for (const Choice& choice : field.choices) {
    out += ' ' + choice.name + '=' + std::to_string(choice.raw);
  }
  return out + (field.description.empty() ? "" : " (" + field.description + ')');
}

std::string shown(const std::vector<Field>& fields) {
  std::string out;
  for (const Field& field : fields) {
    out += shown(field) + '\n';
  }
  return out;
}

std::string shown(const std::vector<MessageKind>& messages) {
  std::string out;
  for (const MessageKind& message : messages) {
    out += message.name + (message.tag ? " tag " + std::to_string(*message.tag) : "") + ": " +
           std::to_string(message.min_length) + ".." + std::to_string(message.max_length) +
           (message.description.empty() ? "" : " (" + message.description + ')') + '\n';
  }
  return out;
}

std::string fields_of(std::string_view fields) {
  const auto kind = parse_kind(
      R"({"roio": 1, "kind": "k", "says": {"m": {"fields": [)" + std::string(fields) + "]}}}", "k");
  return kind ? shown(kind->said.at(0).fields) : kind.error().message;
}

TEST(KindFile, HasAllThatTheFormatHas) {
  const auto kind = load_kind(valid / "everything.kind.json");
  ASSERT_EQ(verdict(kind), "ok");
  EXPECT_EQ(kind->name, "everything");
  EXPECT_EQ(kind->description, "For tests: all that the format has");
  EXPECT_EQ(shown(kind->heard),
            "numbers tag 0: 7..7\n"
            "bits tag 1: 7..8\n"
            "wide: 4..4\n"
            "low tag 2: 5..5\n"
            "empty: 0..0\n");
  EXPECT_EQ(shown(kind->said),
            "answer: 0..0 (The same bytes as empty, in the other direction)\n"
            "any-bytes tag 255: 1..4\n");
  EXPECT_EQ(shown(kind->settings),
            "limit signed at 0+8, -128..127 * 1/2 A\n"
            "side choice at 0+8, 0..255 left=0 right=1\n"
            "flag number at 0+1, 0..1\n");
}

TEST(KindFile, LaysFieldsOut) {
  const auto kind = load_kind(valid / "everything.kind.json");
  ASSERT_EQ(verdict(kind), "ok");
  EXPECT_EQ(shown(kind->hears("numbers")->fields),
            "u24 number at 8+24, 0..16777215\n"
            "i24 signed at 32+24, -8388608..8388607\n");
  EXPECT_EQ(shown(kind->hears("bits")->fields),
            "one number at 8+1, 0..1\n"
            "three number at 9+3, 0..7 (Beside it)\n"
            "mode choice at 12+2, 0..3 off=0 on=1 2x=3\n"
            "five number at 16+5, 0..19\n"
            "i16 signed at 24+16, -400..850 * 1/10 \xC2\xB0"
            "C\n"
            "gear choice at 40+8, 0..255 R=255 N=0 1=1\n"
            "rest bytes at 48+16, 1..2\n");
  EXPECT_EQ(shown(kind->hears("wide")->fields),
            "u32 number at 0+32, 0..4294967295 * 1/1000000 s\n");
  EXPECT_EQ(shown(kind->hears("low")->fields),
            "i32 signed at 8+32, -2147483648..2147483647 * 1000000/1\n");
}

TEST(KindFile, EveryTypeHasItsRange) {
  EXPECT_EQ(fields_of(R"({"name": "a", "type": "u8"}, {"name": "b", "type": "i8"},
                         {"name": "c", "type": "u16"}, {"name": "d", "type": "i16"})"),
            "a number at 0+8, 0..255\n"
            "b signed at 8+8, -128..127\n"
            "c number at 16+16, 0..65535\n"
            "d signed at 32+16, -32768..32767\n");
  EXPECT_EQ(fields_of(R"({"name": "a", "type": "bits", "width": 8}, {"name": "b", "type": "bits"},
                         {"name": "c", "type": "bits", "width": 7},
                         {"name": "d", "type": "bits", "width": 8},
                         {"name": "e", "type": "bytes"})"),
            "a number at 0+8, 0..255\n"
            "b number at 8+1, 0..1\n"
            "c number at 9+7, 0..127\n"
            "d number at 16+8, 0..255\n"
            "e bytes at 24+40, 0..5\n");
}

// Each beside the row of refusals/kind.txt that is one past it.
TEST(KindFile, TakesLimitsThatAreSteps) {
  EXPECT_EQ(fields_of(R"({"name": "a", "type": "u8", "scale": "1/10", "maximum": 0.3})"),
            "a number at 0+8, 0..3 * 1/10\n");
  EXPECT_EQ(fields_of(R"({"name": "a", "type": "u8", "scale": "1/10", "minimum": 25.500e0})"),
            "a number at 0+8, 255..255 * 1/10\n");
  EXPECT_EQ(fields_of(R"({"name": "a", "type": "u8", "scale": 5, "maximum": 1.275E+3})"),
            "a number at 0+8, 0..255 * 5/1\n");
  EXPECT_EQ(
      fields_of(R"({"name": "a", "type": "i8", "scale": "1/3", "minimum": -1, "maximum": 42})"),
      "a signed at 0+8, -3..126 * 1/3\n");
  EXPECT_EQ(fields_of(R"({"name": "a", "type": "u32", "scale": "999999/524288",
                          "maximum": 8191991806.0926532745361328125})"),
            "a number at 0+32, 0..4294967295 * 999999/524288\n")
      << "as many digits as a step can have";
}

TEST(KindFile, TellsMessagesApart) {
  const auto kind = load_kind(valid / "everything.kind.json");
  ASSERT_EQ(verdict(kind), "ok");
  const struct {
    const char* why;
    const char* data;
    const char* heard;
    const char* said;
  } rows[] = {
      {"empty", "", "empty", "answer"},
      {"7 bytes with a tag", "00000000000000", "numbers", "none"},
      {"7 bytes with the other tag", "01000000000000", "bits", "none"},
      {"the same, a byte longer", "0100000000000000", "bits", "none"},
      {"7 bytes with no message's tag", "02000000000000", "none", "none"},
      {"4 bytes, whatever the first is", "02000000", "wide", "none"},
      {"5 bytes with a tag", "0200000000", "low", "none"},
      {"the tag alone", "FF", "none", "any-bytes"},
      {"as long as it may be", "FF000000", "wide", "any-bytes"},
      {"a byte longer", "FF00000000", "none", "none"},
  };
  for (const auto& row : rows) {
    const Bytes bytes = *parse_hex(row.data);
    const std::span data(bytes.data.data(), bytes.length);
    const MessageKind* heard = kind->hears(data);
    const MessageKind* said = kind->says(data);
    EXPECT_EQ(heard != nullptr ? heard->name : "none", row.heard) << row.why;
    EXPECT_EQ(said != nullptr ? said->name : "none", row.said) << row.why;
  }
}

TEST(KindFile, FindsByName) {
  const auto kind = load_kind(valid / "everything.kind.json");
  ASSERT_EQ(verdict(kind), "ok");
  EXPECT_NE(kind->hears("bits"), nullptr);
  EXPECT_EQ(kind->hears("answer"), nullptr) << "what it says is apart";
  EXPECT_NE(kind->says("answer"), nullptr);
  EXPECT_EQ(kind->hears("Bits"), nullptr);
  EXPECT_EQ(kind->hears("bits")->find("five")->width, 5);
  EXPECT_EQ(kind->hears("bits")->find(""), nullptr);
}

TEST(RobotFile, HasAllThatTheFormatHas) {
  const auto robot = load_robot(valid / "robot.json");
  ASSERT_EQ(verdict(robot), "ok");
  EXPECT_EQ(robot->name, "\xC3\x9Cnsere");
  EXPECT_EQ(robot->description, "For tests: all that the format has");
  EXPECT_EQ(robot->version, "1.2-rc");
  EXPECT_EQ(robot->serial_number, "0017");
  EXPECT_EQ(robot->maker, "we");
  EXPECT_EQ(robot->bus, "serial:auto");
  EXPECT_EQ(robot->bitrate, 125000U);
  EXPECT_EQ(robot->file, valid / "robot.json");
  ASSERT_EQ(robot->places.size(), 3U);
  const Place& place = robot->places[0];
  EXPECT_EQ(place.name, "left_wheel");
  EXPECT_EQ(place.description, "In front");
  EXPECT_EQ(to_string(place.address), "0.1");
  ASSERT_NE(place.kind, nullptr);
  EXPECT_EQ(place.kind, robot->places[1].kind) << "a kind is read once";
  EXPECT_EQ(robot->places[2].kind, nullptr);
  EXPECT_EQ(to_string(robot->places[2].address), "31.254");
}

TEST(RobotFile, SettingsAreInTheirUnits) {
  const auto robot = load_robot(valid / "robot.json");
  ASSERT_EQ(verdict(robot), "ok");
  const auto& settings = robot->places[0].settings;
  ASSERT_EQ(settings.size(), 3U);
  EXPECT_EQ(settings[0].name, "limit");
  EXPECT_EQ(*settings[0].value.number(), -1.5);
  EXPECT_EQ(settings[1].name, "side");
  EXPECT_EQ(*settings[1].value.choice(), "left");
  EXPECT_EQ(*settings[2].value.number(), 1.0);
  EXPECT_TRUE(robot->places[1].settings.empty());
}

TEST(RobotFile, Simulation) {
  const auto robot = load_robot(valid / "robot.json");
  ASSERT_EQ(verdict(robot), "ok");
  const auto& board = robot->places[0].simulation;
  ASSERT_TRUE(board);
  EXPECT_EQ(board->board, "mega");
  EXPECT_EQ(board->firmware, "/opt/wheel.elf");
  EXPECT_EQ(board->crystal_hz, 8000000U);
  EXPECT_EQ(board->cs_pin, "53");
  EXPECT_EQ(board->int_pin, "A1");
  ASSERT_EQ(board->pins.size(), 6U);
  EXPECT_EQ(board->pins[0].pin, "3");
  EXPECT_EQ(board->pins[0].type, PinPart::Type::servo);
  EXPECT_EQ(board->pins[5].pin, "A15");
  EXPECT_EQ(board->pins[5].type, PinPart::Type::light);
  EXPECT_EQ(board->pins[5].name, "f");
  const auto& other = robot->places[1].simulation;
  ASSERT_TRUE(other);
  EXPECT_EQ(other->firmware, valid / "../wheel") << "as a program that stands elsewhere finds it";
  EXPECT_EQ(other->crystal_hz, 16000000U);
  EXPECT_EQ(other->cs_pin, std::nullopt);
  EXPECT_FALSE(robot->places[2].simulation);
}

}  // namespace
}  // namespace roio
