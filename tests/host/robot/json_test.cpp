// JSON with names: what it reads and writes, and that it says the same as the bytes.
#include <gtest/gtest.h>

#include <memory>
#include <roio/robot_json.hpp>
#include <string>
#include <vector>

#include "random_kind.hpp"
#include "random_value.hpp"

namespace roio {
namespace {

/// A robot with two boards of a kind and somebody who asks.
Robot robot_of(Kind kind) {
  Robot robot;
  robot.name = "test robot";
  const auto shared = std::make_shared<const Kind>(std::move(kind));
  robot.places = {{"arm", "", {0, 2}, shared, {}, std::nullopt},
                  {"leg", "", {0, 3}, shared, {}, std::nullopt},
                  {"pc", "", {0, 10}, nullptr, {}, std::nullopt}};
  return robot;
}

Kind example_kind() {
  return *parse_kind(R"({"roio": 1, "kind": "k", "hears": {
    "go": {"fields": [{"name": "speed", "type": "i16", "scale": "1/10", "unit": "m/s"},
                      {"name": "gear", "type": "enum", "values": {"low": 0, "2": 5}}]},
    "raw": {"tag": 7, "fields": [{"name": "data", "type": "bytes", "maximum": 1}]},
    "stop": {}}})",
                     "k.kind.json");
}

std::vector<int> data_of(const JsonMessage& json) {
  return {json.message.data, json.message.data + json.message.length};
}

TEST(NamedJson, IsReadAsTheBytesThatItSays) {
  const Robot robot = robot_of(example_kind());
  struct Row {
    const char* text;
    std::vector<int> data;
  };
  for (const Row& row : {
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"speed":-0.3,"gear":"low"}})",
               {0xFF, 0xFD, 0}},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"gear":"2","speed":1}})",
               {0, 10, 5}},
           Row{R"({"type":"Roio","to":"0.2","message":"raw","fields":{"data":[9]}})", {7, 9}},
           Row{R"({"type":"Roio","to":"arm","message":"raw"})", {7}},
           Row{R"({"type":"Roio","to":"arm","message":"stop","fields":{}})", {}},
           Row{R"({"type":"Roio","to":"0.*","message":"stop"})", {}},
           Row{R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":1,)"
               R"("data":[1],"to":"leg","message":"stop","fields":{}})",
               {1}},
       }) {
    const auto json = parse_json(row.text, robot);
    ASSERT_TRUE(json) << row.text << ": " << json.error().message;
    EXPECT_EQ(data_of(*json), row.data) << row.text;
  }
}

TEST(NamedJson, HasTheRestAsWithoutNames) {
  const Robot robot = robot_of(example_kind());
  const auto json = parse_json(
      R"({"type":"Roio","from":"leg","to":"arm","message":"stop","priority":"urgent","timestamp":1.5})",
      robot);
  ASSERT_TRUE(json) << json.error().message;
  EXPECT_TRUE(json->has_source);
  EXPECT_EQ(json->message.header.source, (Address{0, 3}));
  EXPECT_EQ(json->message.header.destination, (Address{0, 2}));
  EXPECT_EQ(json->message.header.priority, Priority::urgent);
  EXPECT_EQ(json->time, Timestamp(std::chrono::milliseconds(1500)));
  const auto of_nobody = parse_json(R"({"type":"Roio","to":"arm","message":"stop"})", robot);
  ASSERT_TRUE(of_nobody);
  EXPECT_FALSE(of_nobody->has_source);
}

TEST(NamedJson, IsRefusedByTheNameOfTheField) {
  const Robot robot = robot_of(example_kind());
  struct Row {
    const char* text;
    const char* begin;
  };
  for (const Row& row : {
           Row{R"({"type":"Roio","to":"amr","message":"stop"})", R"(JSON field "to": "amr")"},
           Row{R"({"type":"Roio","to":2,"message":"stop"})", R"(JSON field "to": 2; expected)"},
           Row{R"({"type":"Roio","message":"stop"})", R"(JSON field "to": missing)"},
           Row{R"({"type":"Roio","to":"arm"})", R"(JSON field "message": missing)"},
           Row{R"({"type":"Roio","to":"arm","message":"fly"})", R"(JSON field "message": "fly")"},
           Row{R"({"type":"Roio","from":"0.*","to":"arm","message":"stop"})",
               R"(JSON field "from": )"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":[]})",
               R"(JSON field "fields": expected an object)"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"speed":true}})",
               R"(JSON field "fields.speed": true; expected)"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"speed":1}})",
               R"(JSON field "fields": go.gear: missing)"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"speed":1e9,"gear":"low"}})",
               R"(JSON field "fields": go.speed)"},
           Row{R"({"type":"Roio","to":"arm","message":"raw","fields":{"data":[256]}})",
               R"(JSON field "fields.data": expected an array)"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","wings":2})", R"(JSON field "wings")"},
           Row{R"({"type":"Roio","to":"arm","to":"leg","message":"stop"})",
               R"(JSON field "to": given twice; expected once)"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"gear":1,"gear":1}})",
               R"(JSON field "fields.gear": given twice; expected once)"},
           Row{R"({"type":"Roio","to":"arm","message":stop})", "JSON: not valid at byte 36"},
           Row{R"({"type":"Roio","to":"arm","message":"stop"} x)",
               R"(JSON: not valid at byte 44: "x")"},
           Row{R"({"type":"Roio","to":"arm")", "JSON: ends too early, after 25 bytes"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"speed":1e999}})",
               "JSON: a number out of range"},
           Row{R"({"type":"Roio","to":[],"message":"go"})",
               R"(JSON field "to": an array; expected)"},
           Row{R"({"type":"Roio","to":"arm","message":"go","fields":{"a\nb":null}})",
               R"(JSON field "fields.a\nb": null; expected)"},
           Row{R"({"type":"Roio","to":"arm","message":"raw","fields":{"data":[[1]]}})",
               "JSON: nested deeper"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","isBroadcast":false})",
               R"(JSON field "isBroadcast": expected none beside "to")"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","address":3})",
               R"(JSON field "address": expected none)"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","subnet":3})",
               R"(JSON field "subnet": expected none)"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","messageLength":3})",
               R"(JSON field "messageLength": expected none)"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","source":"0.3"})",
               R"(JSON field "source": expected none)"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","destination":"0.3"})",
               R"(JSON field "destination": expected none)"},
           Row{R"({"type":"Roio","to":"arm","message":"stop","class":"stream"})",
               R"(JSON field "class": "stream"; expected "message")"},
           Row{R"({"to":"arm","message":"stop"})", R"(JSON field "type")"},
       }) {
    const auto json = parse_json(row.text, robot);
    ASSERT_FALSE(json) << row.text;
    EXPECT_TRUE(json.error().message.starts_with(row.begin)) << json.error().message;
  }
}

// As without names; only that there may be more of it.
TEST(NamedJson, IsRefusedAsATextBeforeItIsRead) {
  const Robot robot = robot_of(example_kind());
  const std::string message = R"({"type":"Roio","to":"arm","message":"stop"})";
  const std::string padding(16384 - message.size(), ' ');
  const auto longest = parse_json(message + padding, robot);
  EXPECT_TRUE(longest) << longest.error().message;
  const std::string open(8000, '[');
  const struct {
    const char* why;
    std::string text;
    std::string begin;
  } rows[] = {
      {"too long", message + padding + ' ', "JSON: 16385 bytes; expected at most"},
      {"too long to be read as bytes, with a zero byte", message + padding.substr(1) + '\0',
       "JSON: a zero byte at byte 16383"},
      {"the same, not UTF-8", message + padding.substr(1) + '\xFF',
       "JSON: not UTF-8 at byte 16383"},
      {"the same, a mark", "\xEF\xBB\xBF" + message + padding.substr(3),
       "JSON: begins with a byte"},
      {"a zero byte", message + '\0', "JSON: a zero byte"},
      {"depth", R"({"to":"arm","fields":)" + open + std::string(8000, ']') + '}',
       "JSON: nested deeper than a message ever is"},
      {"depth without an end", R"({"to":"arm","fields":)" + open, "JSON: nested deeper"},
      {"depth beside bytes", R"({"to":"arm","data":)" + open, "JSON: nested deeper"},
  };
  for (const auto& row : rows) {
    const auto json = parse_json(row.text, robot);
    ASSERT_FALSE(json) << row.why;
    EXPECT_TRUE(json.error().message.starts_with(row.begin)) << row.why << json.error().message;
  }
}

/// "a" says "status", in the same byte in which "b" hears "go" and "halt" of two.
Robot talking_robot() {
  Robot robot = robot_of(*parse_kind(R"({"roio": 1, "kind": "k", "hears": {
      "go": {"fields": [{"name": "x", "type": "u8"}]},
      "halt": {"fields": [{"name": "x", "type": "u16"}]}},
    "says": {"status": {"fields": [{"name": "x", "type": "u8"}]}}})",
                                     "k.kind.json"));
  robot.places.push_back({"zero", "", {0, 0}, robot.places[0].kind, {}, std::nullopt});
  return robot;
}

TEST(NamedJson, IsLookedUpAsFromWhoSendsIt) {
  const Robot robot = talking_robot();
  const std::string status = R"({"type":"Roio","to":"pc","message":"status","fields":{"x":1}})";
  EXPECT_FALSE(parse_json(status, robot)) << "from nobody";
  const auto of_default = parse_json(status, robot, {0, 2});
  ASSERT_TRUE(of_default) << of_default.error().message;
  EXPECT_FALSE(of_default->has_source);
  const std::string from = status.substr(0, status.size() - 1) + R"(,"from":"pc"})";
  EXPECT_FALSE(parse_json(from, robot, {0, 2})) << "who it says goes before";
}

TEST(NamedJson, IsRefusedWhereItsBytesMeanSomethingElse) {
  const Robot robot = talking_robot();
  const std::string go = R"({"type":"Roio","to":"leg","message":"go","fields":{"x":1})";
  EXPECT_TRUE(parse_json(go + '}', robot));
  EXPECT_TRUE(parse_json(go + R"(,"from":"pc"})", robot));
  const auto json = parse_json(go + R"(,"from":"arm"})", robot);
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().message, R"(JSON field "message": go: from arm these bytes are status)");
  EXPECT_TRUE(parse_json(
      R"({"type":"Roio","from":"arm","to":"leg","message":"halt","fields":{"x":1}})", robot));
}

// 0.0 may be a place, and has a kind here that says the same byte.
TEST(NamedJson, OfNobodyIsNotWrittenAsFromAPlace) {
  const Robot robot = talking_robot();
  JsonMessage json;
  json.message = Message{{Priority::normal, MessageClass::message, {0, 2}, {0, 0}}, 1, {1}};
  EXPECT_TRUE(to_json(json, robot).ends_with(R"("to":"arm","message":"go","fields":{"x":1}})"))
      << to_json(json, robot);
  json.has_source = true;
  EXPECT_TRUE(to_json(json, robot).ends_with(R"("message":"status","fields":{"x":1}})"))
      << to_json(json, robot);
}

TEST(NamedJson, IsWrittenBesideTheBytes) {
  const Robot robot = robot_of(example_kind());
  JsonMessage json;
  json.message =
      Message{{Priority::normal, MessageClass::message, {0, 2}, {0, 10}}, 3, {0xFF, 0xFD, 5}};
  json.has_source = true;
  const std::string bytes =
      R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":3,"data":[255,253,5],"source":"0.10")";
  EXPECT_EQ(
      to_json(json, robot),
      bytes + R"(,"from":"pc","to":"arm","message":"go","fields":{"speed":-0.3,"gear":"2"}})");
  json.message.data[2] = 6;  // no choice has it
  EXPECT_TRUE(to_json(json, robot).ends_with(R"("fields":{"speed":-0.3,"gear":6}})"))
      << to_json(json, robot);
  json.message.header.destination = {9, 9};
  EXPECT_TRUE(to_json(json, robot).ends_with(R"("source":"0.10","from":"pc"})"))
      << to_json(json, robot);
}

// What to_json() writes is read as the same message, with the bytes and without them.
TEST(NamedJson, OfRandomKindsSaysTheSameAsTheBytes) {
  std::mt19937 random = test::seeded_generator();
  test::RandomKind kinds(random);
  for (int i = 0; i < 2000; ++i) {
    const std::string text = kinds.text();
    const auto kind = parse_kind(text, "k.kind.json");
    ASSERT_TRUE(kind) << text;
    const MessageKind& message = kind->heard.front();
    std::vector<NamedValue> values;
    for (const Field& field : message.fields) {
      values.push_back({field.name, test::value_of(test::random_value(field, random))});
    }
    const auto bytes = pack(message, values);
    ASSERT_TRUE(bytes) << text << bytes.error().message;
    const Robot robot = robot_of(*kind);
    JsonMessage json;
    json.message.header = {Priority::normal, MessageClass::message, {0, 2}, {0, 10}};
    json.message.length = bytes->length;
    std::copy_n(bytes->data.begin(), bytes->length, json.message.data);
    const std::string whole = to_json(json, robot);
    const auto of_bytes = parse_json(whole, robot);
    ASSERT_TRUE(of_bytes) << text << whole << of_bytes.error().message;
    EXPECT_EQ(data_of(*of_bytes), data_of(json)) << text << whole;
    const std::string names = R"({"type":"Roio",)" + whole.substr(whole.find(R"("to":)"));
    const auto of_names = parse_json(names, robot);
    ASSERT_TRUE(of_names) << text << names << of_names.error().message;
    EXPECT_EQ(data_of(*of_names), data_of(json)) << text << names;
  }
}

}  // namespace
}  // namespace roio
