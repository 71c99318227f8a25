// A robot's names: places, addresses, and what messages mean on their way.
#include <gtest/gtest.h>

#include <roio/robot.hpp>
#include <string>

#include "folder.hpp"
#include "parsing.hpp"

namespace roio {
namespace {

using test::verdict;

/// Two wheels of a kind, a lamp that means the same by "stop" and something else by "set", a pc.
class RobotNames : public test::RobotFolder {
 protected:
  RobotNames() {
    write("wheel.kind.json", R"({"roio": 1, "kind": "wheel",
      "hears": {"stop": {"tag": 0}, "set": {"fields": [{"name": "speed", "type": "i16"}]},
                "turn": {"fields": [{"name": "angle", "type": "u24"}]}},
      "says": {"speed": {"fields": [{"name": "speed", "type": "i16"}]},
               "set": {"fields": [{"name": "which", "type": "u8"}]}}})");
    write("lamp.kind.json", R"({"roio": 1, "kind": "lamp",
      "hears": {"stop": {"tag": 0, "description": "Off, at once"},
                "set": {"fields": [{"name": "colour", "type": "u16"}]},
                "dim": {"fields": [{"name": "to", "type": "u32"}]}}})");
    write("robot.json", R"({"roio": 1, "name": "r", "places": {
      "left": {"address": "0.1", "kind": "wheel"},
      "right": {"address": "0.2", "kind": "wheel"},
      "lamp": {"address": "0.3", "kind": "lamp"},
      "pc": {"address": "0.10"},
      "far": {"address": "1.1", "kind": "lamp"}}})");
  }

  [[nodiscard]] static Robot robot() {
    const auto robot = load_robot("robot.json");
    EXPECT_EQ(verdict(robot), "ok");
    return *robot;
  }
};

/// "set speed=258"; the first field alone, and of one that is called as its message its name alone.
std::string shown(const std::optional<NamedMessage>& message) {
  if (!message) {
    return "bytes";
  }
  if (message->readings.empty()) {
    return message->kind->name;
  }
  const Reading& reading = message->readings[0];
  std::string out = message->kind->name == reading.field->name ? "" : message->kind->name + ' ';
  out += reading.field->name;
  out += '=' + reading.text();
  return out;
}

/// A kind that hears "m" with these fields.
std::string kind_text(const std::string& name, const std::string& fields) {
  std::string out = R"({"roio": 1, "kind": ")";
  out += name;
  out += R"(", "hears": {"m": {"fields": [)";
  out += fields;
  return out + "]}}}";
}

constexpr Address left{0, 1};
constexpr Address right{0, 2};
constexpr Address lamp{0, 3};
constexpr Address pc{0, 10};
constexpr Address stranger{0, 99};
constexpr Address all{0, broadcast_node};
constexpr Address all_far{1, broadcast_node};

TEST_F(RobotNames, PlacesAndAddresses) {
  const Robot robot = RobotNames::robot();
  ASSERT_NE(robot.find("left"), nullptr);
  EXPECT_EQ(robot.find("left")->address, left);
  EXPECT_EQ(robot.find("Left"), nullptr);
  EXPECT_EQ(robot.find(""), nullptr);
  EXPECT_EQ(robot.find(right)->name, "right");
  EXPECT_EQ(robot.find(stranger), nullptr);
  EXPECT_EQ(robot.find(all), nullptr);
  EXPECT_EQ(robot.name_of(left), "left");
  EXPECT_EQ(robot.name_of(stranger), "0.99");
  EXPECT_EQ(robot.name_of(all), "0.*");
}

TEST_F(RobotNames, AddressOfWhatPeopleType) {
  const Robot robot = RobotNames::robot();
  const struct {
    const char* text;
    const char* result;
  } rows[] = {
      {"left", "0.1"},
      {"far", "1.1"},
      {"0.7", "0.7"},
      {"1.*", "1.*"},
      {"0.300",
       R"(address "0.300": node 300 is out of range; expected 0..254, or * for a broadcast)"},
      {"lfet", R"("lfet": no such place; did you mean "left"?)"},
      {"LAMP", R"("LAMP": no such place; did you mean "lamp"?)"},
      {"", R"("": no such place; expected one of left, right, lamp, pc, far)"},
      {"wheel", R"("wheel": no such place; expected one of left, right, lamp, pc, far)"},
  };
  for (const auto& row : rows) {
    const auto address = robot.address_of(row.text);
    EXPECT_EQ(address ? to_string(*address) : address.error().message, row.result);
  }
  EXPECT_EQ(verdict(Robot{}.address_of("arm")), R"("arm": no such place; the robot has none)");
}

TEST_F(RobotNames, MeaningOfBytes) {
  const Robot robot = RobotNames::robot();
  const struct {
    const char* why;
    Address source;
    Address destination;
    const char* data;
    const char* meaning;
  } rows[] = {
      {"the sender says it", left, pc, "0102", "speed=258"},
      {"and that goes before what the receiver hears", left, right, "0102", "speed=258"},
      {"to whom a lamp would hear another", left, lamp, "0102", "speed=258"},
      {"of a broadcast, too", left, all, "0102", "speed=258"},
      {"a sender without a kind: the receiver hears it", pc, left, "0102", "set speed=258"},
      {"the lamp hears otherwise", pc, lamp, "0102", "set colour=258"},
      {"a sender who is nowhere", stranger, left, "0102", "set speed=258"},
      {"a sender who does not say it: the receiver's", lamp, left, "0102", "set speed=258"},
      {"not what the sender hears", left, pc, "010203", "bytes"},
      {"nobody knows it", pc, stranger, "0102", "bytes"},
      {"of a length that nobody has", pc, left, "0102030405", "bytes"},
      {"a broadcast that all mean alike, but for people", pc, all, "00", "stop"},
      {"a broadcast of which they disagree", pc, all, "0102", "bytes"},
      {"a broadcast that only wheels know", pc, all, "010203", "turn angle=66051"},
      {"a broadcast that only lamps know", pc, all, "01020304", "dim to=16909060"},
      {"a broadcast to another subnet", pc, all_far, "0102", "set colour=258"},
      {"where nobody knows it", pc, all_far, "010203", "bytes"},
      {"a subnet without places", pc, Address{7, broadcast_node}, "0102", "bytes"},
      {"by a place that hears it itself", lamp, all, "0102", "set speed=258"},
  };
  for (const auto& row : rows) {
    const Bytes bytes = *parse_hex(row.data);
    Message message{
        {Priority::urgent, MessageClass::message, row.destination, row.source}, bytes.length, {}};
    std::copy(bytes.data.begin(), bytes.data.end(), message.data);
    const auto named = robot.decode(message);
    EXPECT_EQ(shown(named), row.meaning) << row.why;
    message.header.message_class = MessageClass::system;
    EXPECT_FALSE(robot.decode(message)) << "class message alone has names";
  }
}

TEST_F(RobotNames, MessagesByName) {
  const Robot robot = RobotNames::robot();
  const struct {
    const char* why;
    Address source;
    Address destination;
    const char* name;
    const char* result;  ///< The first field, or why not.
  } rows[] = {
      {"the sender says it", left, lamp, "set", "which"},
      {"the receiver hears it", pc, lamp, "set", "colour"},
      {"the other one", pc, left, "set", "speed"},
      {"who does not say it hears it", lamp, left, "set", "speed"},
      {"all mean alike", pc, all, "stop", "none"},
      {"only wheels", pc, all, "turn", "angle"},
      {"the disagreement names two", pc, all, "set",
       R"("set": left and lamp mean different things by it; expected a message to one of them)"},
      {"a slip of the pen", pc, left, "strop",
       R"("strop": no such message to left; did you mean "stop"?)"},
      {"none like it", pc, left, "fly",
       R"("fly": no such message to left; expected one of stop, set, turn)"},
      {"what the sender says is listed first", left, lamp, "fly",
       R"("fly": no such message to lamp; expected one of speed, set, stop, dim)"},
      {"a broadcast's, each once", pc, all, "fly",
       R"("fly": no such message to 0.*; expected one of stop, set, turn, dim)"},
      {"nobody there", pc, stranger, "set",
       R"("set": no such message to 0.99; no kind says what 0.99 hears)"},
      {"a place without a kind", left, pc, "stop",
       R"("stop": no such message to pc; expected one of speed, set)"},
  };
  for (const auto& row : rows) {
    const auto found = robot.message(row.source, row.destination, row.name);
    std::string result = found ? "none" : found.error().message;
    if (found && !(*found)->fields.empty()) {
      result = (*found)->fields[0].name;
    }
    EXPECT_EQ(result, row.result) << row.why;
  }
}

// What a broadcast means when two hear it, who differ in one thing.
TEST_F(RobotNames, BroadcastsMeanTheSameOrNothing) {
  write("robot.json", R"({"roio": 1, "name": "r", "places": {
    "a": {"address": "0.1", "kind": "a"}, "b": {"address": "0.2", "kind": "b"}}})");
  const std::string plain = R"({"name": "x", "type": "u8"})";
  const std::string choice = R"({"name": "x", "type": "enum", "values": {"on": 1, "off": 0}})";
  const struct {
    const char* why;
    std::string one;
    std::string other;
    bool agree;
  } rows[] = {
      {"nothing", plain, plain, true},
      {"the description", plain, R"({"name": "x", "type": "u8", "description": "d"})", true},
      {"a maximum that is the type's", plain, R"({"name": "x", "type": "u8", "maximum": 255})",
       true},
      {"the name", plain, R"({"name": "y", "type": "u8"})", false},
      {"the unit", plain, R"({"name": "x", "type": "u8", "unit": "V"})", false},
      {"the sign", plain, R"({"name": "x", "type": "i8", "minimum": 0, "maximum": 100})", false},
      {"the scale", plain, R"({"name": "x", "type": "u8", "scale": 2})", false},
      {"the scale's other part", plain, R"({"name": "x", "type": "u8", "scale": "1/2"})", false},
      {"the minimum", plain, R"({"name": "x", "type": "u8", "minimum": 1})", false},
      {"the maximum", plain, R"({"name": "x", "type": "u8", "maximum": 254})", false},
      {"the width", plain, R"({"name": "x", "type": "bits", "width": 7})", false},
      {"another field", R"({"name": "x", "type": "bits"})",
       R"({"name": "x", "type": "bits"}, {"name": "y", "type": "bits"})", false},
      {"the place in the byte", R"({"name": "x", "type": "bits"}, {"name": "y", "type": "bits"})",
       R"({"name": "y", "type": "bits"}, {"name": "x", "type": "bits"})", false},
      {"no choices", choice, choice, true},
      {"the order of the choices", choice,
       R"({"name": "x", "type": "enum", "values": {"on": 1, "off": 0}})", true},
      {"the other order", choice, R"({"name": "x", "type": "enum", "values": {"off": 0, "on": 1}})",
       true},
      {"a choice", choice, R"({"name": "x", "type": "enum", "values": {"on": 1, "no": 0}})", false},
      {"a choice's number", choice,
       R"({"name": "x", "type": "enum", "values": {"on": 2, "off": 0}})", false},
  };
  for (const auto& row : rows) {
    write("a.kind.json", kind_text("a", row.one));
    write("b.kind.json", kind_text("b", row.other));
    const Robot robot = RobotNames::robot();
    const std::uint8_t data[] = {0};
    const Header header{Priority::normal, MessageClass::message, all, pc};
    EXPECT_EQ(robot.meaning(header, data) != nullptr, row.agree) << row.why;
    EXPECT_EQ(robot.message(pc, all, "m").ok(), row.agree) << row.why;
  }
}

TEST_F(RobotNames, Encode) {
  const Robot robot = RobotNames::robot();
  const auto message = robot.encode("left", "set", {{"speed", -2}});
  ASSERT_EQ(verdict(message), "ok");
  EXPECT_EQ(message->header.priority, Priority::normal);
  EXPECT_EQ(message->header.message_class, MessageClass::message);
  EXPECT_EQ(message->header.destination, left);
  EXPECT_EQ(to_hex(message->data, message->length), "FFFE");
  EXPECT_EQ(message->header.source, broadcast_of(0)) << "nobody; 0.0 may be a place";
  EXPECT_EQ(verdict(robot.encode("0.1", "set", {{"speed", 1}})), "ok") << "by its address";
  EXPECT_EQ(robot.encode("0.*", "stop", {})->header.destination, all);
  EXPECT_EQ(
      verdict(robot.encode("0.*", "set", {{"speed", 1}})),
      R"("set": left and lamp mean different things by it; expected a message to one of them)");
  EXPECT_EQ(verdict(robot.encode("leftt", "set", {})),
            R"("leftt": no such place; did you mean "left"?)");
  EXPECT_EQ(verdict(robot.encode("left", "sett", {})),
            R"("sett": no such message to left; did you mean "set"?)");
  EXPECT_EQ(verdict(robot.encode("left", "set", {{"speed", 40000}})),
            "set.speed: 40000; expected a number -32768..32767");
  EXPECT_EQ(verdict(robot.encode("left", "speed", {{"speed", 1}})),
            R"("speed": no such message to left; expected one of stop, set, turn)")
      << "what it says is not for it";
}

TEST_F(RobotNames, WhatWasDecodedLastsAsLongAsACopy) {
  std::optional<Robot> first = robot();
  const Robot copy = *first;
  const auto named = first->decode(*first->encode("left", "set", {{"speed", 7}}));
  ASSERT_TRUE(named);
  first.reset();
  EXPECT_EQ(named->kind, copy.find("right")->kind->hears("set"));
  EXPECT_EQ(named->readings[0].text(), "7");
}

}  // namespace
}  // namespace roio
