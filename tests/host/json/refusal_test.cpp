#include <gtest/gtest.h>

#include <roio/json.hpp>
#include <string_view>

#include "parsing.hpp"

namespace roio {
namespace {

using test::Refusal;
using test::verdict;

constexpr std::string_view good =
    R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":1,"data":[7]})";

// The good message with one text of it replaced.
std::string with(std::string_view from, std::string_view to) {
  std::string text(good);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string adding(std::string_view additions) {
  return with("[7]", "[7]," + std::string(additions));
}

void expect_refused(const Refusal& row) {
  const auto parsed = parse_json(row.text);
  ASSERT_EQ(verdict(parsed), row.message) << row.why;
  EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
}

TEST(JsonRefusal, StartsFromAGoodMessage) {
  EXPECT_EQ(verdict(parse_json(good)), "ok");
}

TEST(JsonRefusal, MissingFields) {
  const std::size_t end = good.size();
  const Refusal cases[] = {
      {"nothing at all", "{}", R"(JSON field "type": missing; expected "Roio")", 2},
      {"type", with(R"("type":"Roio",)", ""), R"(JSON field "type": missing; expected "Roio")",
       end - 14},
      {"isBroadcast", with(R"("isBroadcast":false,)", ""),
       R"(JSON field "isBroadcast": missing; expected true or false)", end - 20},
      {"address", with(R"("address":2,)", ""),
       R"(JSON field "address": missing; expected an integer 0..254)", end - 12},
      {"subnet", with(R"("subnet":0,)", ""),
       R"(JSON field "subnet": missing; expected an integer 0..31)", end - 11},
      {"messageLength", with(R"("messageLength":1,)", ""),
       R"(JSON field "messageLength": missing; expected an integer 0..8)", end - 18},
      {"data", with(R"(,"data":[7])", ""),
       R"(JSON field "data": missing; expected an array of up to 8 integers 0..255)", end - 11},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(JsonRefusal, WrongTypes) {
  const Refusal cases[] = {
      {"another type of message", with("Roio", "MoveRobot"),
       R"(JSON field "type": "MoveRobot"; expected "Roio")", 0},
      {"type in lower case", with("Roio", "roio"), R"(JSON field "type": "roio"; expected "Roio")",
       0},
      {"type a number", with(R"("Roio")", "1"), R"(JSON field "type": 1; expected "Roio")", 0},
      {"isBroadcast a number", with("false", "0"),
       R"(JSON field "isBroadcast": 0; expected true or false)", 0},
      {"isBroadcast a string", with("false", R"("false")"),
       R"(JSON field "isBroadcast": "false"; expected true or false)", 0},
      {"address true", with(":2", ":true"),
       R"(JSON field "address": true; expected an integer 0..254)", 0},
      {"address null", with(":2", ":null"),
       R"(JSON field "address": null; expected an integer 0..254)", 0},
      {"address an object", with(":2", ":{}"),
       R"(JSON field "address": an object; expected an integer 0..254)", 0},
      {"address an array", with(":2", ":[2]"),
       R"(JSON field "address": an array; expected an integer 0..254)", 0},
      {"data a number", with("[7]", "7"),
       R"(JSON field "data": 7; expected an array of up to 8 integers 0..255)", 0},
      {"data hexadecimal", with("[7]", R"("07")"),
       R"(JSON field "data": "07"; expected an array of up to 8 integers 0..255)", 0},
      {"data an object", with("[7]", "{}"),
       R"(JSON field "data": an object; expected an array of up to 8 integers 0..255)", 0},
      {"a byte that is a string", with("[7]", R"([7,"8"])"),
       R"(JSON field "data": "8" at index 1; expected integers 0..255)", 0},
      {"a byte that is null", with("[7]", "[null]"),
       R"(JSON field "data": null at index 0; expected integers 0..255)", 0},
      {"a byte that is false", with("[7]", "[false]"),
       R"(JSON field "data": false at index 0; expected integers 0..255)", 0},
      {"priority a number", adding(R"("priority":0)"),
       R"(JSON field "priority": 0; expected "urgent" or "normal")", 0},
      {"timestamp a string", adding(R"("timestamp":"2015-07-10")"),
       R"(JSON field "timestamp": "2015-07-10"; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"an array of messages", "[" + std::string(good) + "]",
       R"(JSON: an array; expected an object such as {"type":"Roio",...})", 0},
      {"a string", R"("Roio")", R"(JSON: "Roio"; expected an object such as {"type":"Roio",...})",
       0},
      {"a number", "1", R"(JSON: 1; expected an object such as {"type":"Roio",...})", 0},
      {"null", "null", R"(JSON: null; expected an object such as {"type":"Roio",...})", 0},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(JsonRefusal, NumbersOutOfRange) {
  const Refusal cases[] = {
      {"address one past", with(":2", ":256"),
       R"(JSON field "address": 256; expected an integer 0..254)", 0},
      {"the broadcast's, without saying so", with(":2", ":255"),
       R"(JSON field "address": 255 without isBroadcast true; expected an integer 0..254)", 0},
      {"negative", with(":2", ":-1"), R"(JSON field "address": -1; expected an integer 0..254)", 0},
      {"minus zero", with(":2", ":-0"), R"(JSON field "address": -0; expected an integer 0..254)",
       0},
      {"a fraction", with(":2", ":1.5"), R"(JSON field "address": 1.5; expected an integer 0..254)",
       0},
      {"a whole fraction", with(":2", ":2.0"),
       R"(JSON field "address": 2.0; expected an integer 0..254)", 0},
      {"an exponent", with(":2", ":2e0"),
       R"(JSON field "address": 2e0; expected an integer 0..254)", 0},
      {"past 8 bits to a good one", with(":2", ":258"),
       R"(JSON field "address": 258; expected an integer 0..254)", 0},
      {"past 64 bits", with(":2", ":18446744073709551618"),
       R"(JSON field "address": 18446744073709551618; expected an integer 0..254)", 0},
      {"past a double", with(":2", ":1e400"),
       R"(JSON field "address": 1e400; expected an integer 0..254)", 0},
      {"very many digits", with(":2", ":" + std::string(1000, '9')),
       R"(JSON field "address": "999999999999999999999999999999999999999999999999..." )"
       R"((1000 bytes); expected an integer 0..254)",
       0},
      {"subnet one past", with(R"("subnet":0)", R"("subnet":32)"),
       R"(JSON field "subnet": 32; expected an integer 0..31)", 0},
      {"length one past", with("Length\":1", "Length\":9"),
       R"(JSON field "messageLength": 9; expected an integer 0..8)", 0},
      {"a byte one past", with("[7]", "[7,256]"),
       R"(JSON field "data": 256 at index 1; expected integers 0..255)", 0},
      {"a byte below", with("[7]", "[-1]"),
       R"(JSON field "data": -1 at index 0; expected integers 0..255)", 0},
      {"a byte and a half", with("[7]", "[1.5]"),
       R"(JSON field "data": 1.5 at index 0; expected integers 0..255)", 0},
      {"a byte past a double", with("[7]", "[1e400]"),
       R"(JSON field "data": 1e400 at index 0; expected integers 0..255)", 0},
      {"nine bytes", with("[7]", "[1,2,3,4,5,6,7,8,9]"),
       R"(JSON field "data": 9 bytes; a frame carries at most 8)", 0},
      {"before 1970", adding(R"("timestamp":-1)"),
       R"(JSON field "timestamp": -1; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"before 1970 by a fraction", adding(R"("timestamp":-0.5)"),
       R"(JSON field "timestamp": -0.5; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"before 1970 with an exponent", adding(R"("timestamp":-1e3)"),
       R"(JSON field "timestamp": -1e3; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"a nanosecond too late", adding(R"("timestamp":9223372036.854775808)"),
       R"(JSON field "timestamp": 9223372036.854775808; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"milliseconds taken for seconds", adding(R"("timestamp":1436509052249)"),
       R"(JSON field "timestamp": 1436509052249; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"too late by its exponent", adding(R"("timestamp":9.3e9)"),
       R"(JSON field "timestamp": 9.3e9; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
      {"a time past a double", adding(R"("timestamp":1e400)"),
       R"(JSON field "timestamp": 1e400; )"
       R"(expected seconds since 1970, a number 0..9223372036.854775807)",
       0},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(JsonRefusal, ContradictionsAndNames) {
  const Refusal cases[] = {
      {"length above the data", with("Length\":1", "Length\":2"),
       R"(JSON field "messageLength": 2, but "data" has 1)", 0},
      {"length below the data", with("[7]", "[7,8,9]"),
       R"(JSON field "messageLength": 1, but "data" has 3)", 0},
      {"a broadcast to one node", with("false", "true"),
       R"(JSON field "address": 2 in a broadcast; expected 255, or none)", 0},
      {"another destination", adding(R"("destination":"0.3")"),
       R"(JSON field "destination": "0.3", but "subnet" and "address" say "0.2")", 0},
      {"a broadcast destination", adding(R"("destination":"0.*")"),
       R"(JSON field "destination": "0.*", but "subnet" and "address" say "0.2")", 0},
      {"no destination", adding(R"("destination":"arm")"),
       R"(JSON field "destination": address "arm": no dot; expected SUBNET.NODE, such as 0.2)", 0},
      {"a source that is none", adding(R"("source":"0.300")"),
       R"(JSON field "source": address "0.300": node 300 is out of range; expected 0..254)", 0},
      {"a source that is a broadcast", adding(R"("source":"0.*")"),
       R"(JSON field "source": address "0.*": )"
       R"(a broadcast is no address of a node's own; expected node 0..254)",
       0},
      {"a priority that is none", adding(R"("priority":"high")"),
       R"(JSON field "priority": "high"; expected "urgent" or "normal")", 0},
      {"the class that is never sent", adding(R"("class":"reserved")"),
       R"(JSON field "class": "reserved"; expected "message", "system" or "stream")", 0},
      {"a class that is none", adding(R"("class":"")"),
       R"(JSON field "class": ""; expected "message", "system" or "stream")", 0},
      {"a software module",
       R"({"type":"Roio","subnet":"server","address":"armControl","messageLength":0,"data":[]})",
       R"(JSON field "subnet": "server" addresses a software module, which is on no bus; )"
       R"(expected an integer 0..31)",
       0},
      {"a module's name", with(":2", R"(:"armControl")"),
       R"(JSON field "address": "armControl" addresses a software module, which is on no bus; )"
       R"(expected an integer 0..254)",
       0},
      {"given twice", adding(R"("address":2)"),
       R"(JSON field "address": given twice; expected once)", 0},
      {"given twice, once with an escape", adding(R"("\u0074ype":"Roio")"),
       R"(JSON field "type": given twice; expected once)", 0},
      {"unknown", adding(R"("length":1)"),
       R"(JSON field "length": unknown; expected one of type, isBroadcast, address, subnet, )"
       R"(messageLength, data, priority, class, source, destination, timestamp)",
       0},
      {"capitals", adding(R"("Priority":"urgent")"),
       R"(JSON field "Priority": unknown; expected one of type, isBroadcast, address, subnet, )"
       R"(messageLength, data, priority, class, source, destination, timestamp)",
       0},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(JsonRefusal, NoJson) {
  const std::size_t end = good.size();
  const Refusal cases[] = {
      {"empty", "", "JSON: ends too early, after 0 bytes", 0},
      {"white space", " \n", "JSON: ends too early, after 2 bytes", 2},
      {"cut short", std::string(good.substr(0, end - 1)),
       R"(JSON: ends too early, after 86 bytes, in or after field "data")", end - 1},
      {"cut in a name", R"({"ty)", "JSON: ends too early, after 4 bytes", 4},
      {"cut in a text", R"({"type":"Ro)",
       R"(JSON: ends too early, after 11 bytes, in or after field "type")", 11},
      {"more", std::string(good) + "x", R"(JSON: "x" after the message; expected nothing more)",
       end},
      {"a word that begins as true does", std::string(good) + " trailing",
       R"(JSON: "trailing" after the message; expected nothing more)", end + 1},
      {"words, the first of which is JSON", std::string(good) + "12 x",
       R"(JSON: "12 x" after the message; expected nothing more)", end},
      {"half a text", std::string(good) + " \"abc",
       R"(JSON: "\"abc" after the message; expected nothing more)", end + 1},
      {"a brace in a text of it", with("Roio", "}") + " }",
       R"(JSON field "type": "}"; expected "Roio")", 0},
      {"a word that begins as null does", with(":2", ":nope"),
       R"(JSON: not valid at byte 45, in or after field "address": )"
       R"("nope,\"subnet\":0,\"messageLength\":1,\"data\":[7]}")",
       45},
      {"another message", std::string(good) + "\n{}",
       R"(JSON: "{}" after the message; expected nothing more)", end + 1},
      {"not a number", with(":2", ":NaN"),
       R"(JSON: not valid at byte 45, in or after field "address": )"
       R"("NaN,\"subnet\":0,\"messageLength\":1,\"data\":[7]}")",
       45},
      {"infinite", with(":2", ":Infinity"),
       R"(JSON: not valid at byte 45, in or after field "address": )"
       R"("Infinity,\"subnet\":0,\"messageLength\":1,\"data\":[7]..." (49 bytes))",
       45},
      {"a leading zero", with(":2", ":02"),
       R"(JSON: not valid at byte 45, in or after field "address": )"
       R"("02,\"subnet\":0,\"messageLength\":1,\"data\":[7]}")",
       45},
      {"a plus", with(":2", ":+2"),
       R"(JSON: not valid at byte 45, in or after field "address": )"
       R"("+2,\"subnet\":0,\"messageLength\":1,\"data\":[7]}")",
       45},
      {"a comma too many", with("[7]}", "[7],}"),
       R"(JSON: not valid at byte 87, in or after field "data": "}")", 87},
      {"single quotes", "{'type':'Roio'}", R"(JSON: not valid at byte 1: "'type':'Roio'}")", 1},
      {"a comment", "/**/{}", R"(JSON: not valid at byte 0: "/**/{}")", 0},
      {"a zero byte", std::string("{\0}", 3), "JSON: a zero byte at byte 1; expected text", 1},
      {"a zero byte and more after the message", std::string(good) + '\0' + "GARBAGE",
       "JSON: a zero byte at byte 87; expected text", end},
      {"a zero byte in a text of it", with("Roio", std::string("Ro\0o", 4)),
       "JSON: a zero byte at byte 11; expected text", 11},
      {"a byte order mark", "\xEF\xBB\xBF" + std::string(good),
       "JSON: begins with a byte order mark; expected none", 0},
      {"a line end in a text", "{\"type\":\"Ro\nio\"}",
       R"(JSON: not valid at byte 11, in or after field "type": "\nio\"}")", 11},
      {"half a surrogate pair", R"({"type":"\ud800"})",
       R"(JSON: not valid at byte 15, in or after field "type": "\"}")", 15},
      {"not UTF-8", with("Roio", "Ro\xFFio"), R"(JSON: not UTF-8 at byte 11, "\xFF")", 11},
      {"not UTF-8 outside of texts", "{\xC3}", R"(JSON: not UTF-8 at byte 1, "\xC3")", 1},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(JsonRefusal, DeepNestingAndHugeTexts) {
  std::string objects;
  for (int i = 0; i < 600; ++i) {
    objects += R"({"a":)";
  }
  const Refusal cases[] = {
      {"4,096 arrays", std::string(4096, '['),
       R"(JSON: an array; expected an object such as {"type":"Roio",...})", 0},
      {"arrays in the data", R"({"data":)" + std::string(4000, '['),
       R"(JSON field "data": an array at index 0; expected integers 0..255)", 0},
      {"objects in a field", R"({"source":)" + objects,
       R"(JSON field "source": an object; expected "SUBNET.NODE", such as "0.10")", 0},
      {"as much as fits of data", R"({"data":[)" + std::string(2000, '1').replace(1, 1, ",") + "]}",
       R"(JSON field "data": "111111111111111111111111111111111111111111111111..." (1998 bytes) )"
       R"(at index 1; expected integers 0..255)",
       0},
      {"ten megabytes", std::string(10000000, '['), "JSON: 10000000 bytes; expected at most 4096",
       4096},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

}  // namespace
}  // namespace roio
