#include <gtest/gtest.h>

#include <roio/json.hpp>
#include <vector>

#include "parsing.hpp"

namespace roio {
namespace {

using test::verdict;

struct DecodeCase {
  const char* why;
  std::string text;
  Header header;
  bool has_source;
  std::vector<std::uint8_t> data;
  std::optional<std::int64_t> time_ns;
};

constexpr Header plain(Address destination) {
  return {Priority::normal, MessageClass::message, destination, {0, 0}};
}

void expect_decoded(const DecodeCase& row) {
  const auto parsed = parse_json(row.text);
  ASSERT_EQ(verdict(parsed), "ok") << row.why;
  const Message& message = parsed->message;
  EXPECT_EQ(message.header, row.header) << row.why;
  EXPECT_EQ(std::vector<std::uint8_t>(message.data, message.data + message.length), row.data)
      << row.why;
  EXPECT_EQ(parsed->has_source, row.has_source) << row.why;
  ASSERT_EQ(parsed->time.has_value(), row.time_ns.has_value()) << row.why;
  if (row.time_ns) {
    EXPECT_EQ(parsed->time->time_since_epoch().count(), *row.time_ns) << row.why;
  }
}

TEST(JsonDecode, TheOriginalsMessages) {
  const DecodeCase cases[] = {
      {"to a node",
       R"({"type":"Roio","isBroadcast":false,"address":25,"subnet":10,)"
       R"("messageLength":4,"data":[10,20,30,40]})",
       plain({10, 25}),
       false,
       {10, 20, 30, 40},
       {}},
      {"to everybody, without an address",
       R"({"type":"Roio","isBroadcast":true,"subnet":31,"messageLength":1,"data":[0]})",
       plain({31, 255}),
       false,
       {0},
       {}},
      {"to everybody, with its address",
       R"({"type":"Roio","isBroadcast":true,"address":255,"subnet":0,"messageLength":0,"data":[]})",
       plain({0, 255}),
       false,
       {},
       {}},
      {"in another order, with white space",
       " {\t\"data\" : [ 255 , 0,1,2,3,4,5,6 ]\n,\"messageLength\":8,\r\n"
       R"("subnet":0,"address":254,"isBroadcast":false,"type":"Roio" } )",
       plain({0, 254}),
       false,
       {255, 0, 1, 2, 3, 4, 5, 6},
       {}},
      {"names and words written with escapes",
       R"({"\u0074ype":"R\u006fio","isBroadcast":false,"address":0,"subnet":0,)"
       R"("messageLength":0,"data":[]})",
       plain({0, 0}),
       false,
       {},
       {}},
  };
  for (const DecodeCase& row : cases) {
    expect_decoded(row);
  }
}

std::string with(const std::string& additions) {
  return R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":1,"data":[7])" +
         additions + '}';
}

TEST(JsonDecode, Additions) {
  const Address to{0, 2};
  const DecodeCase cases[] = {
      {"urgent",
       with(R"(,"priority":"urgent")"),
       {Priority::urgent, MessageClass::message, to, {0, 0}},
       false,
       {7},
       {}},
      {"normal, said",
       with(R"(,"priority":"normal","class":"message")"),
       plain(to),
       false,
       {7},
       {}},
      {"system",
       with(R"(,"class":"system")"),
       {Priority::normal, MessageClass::system, to, {0, 0}},
       false,
       {7},
       {}},
      {"stream",
       with(R"(,"class":"stream")"),
       {Priority::normal, MessageClass::stream, to, {0, 0}},
       false,
       {7},
       {}},
      {"source",
       with(R"(,"source":"31.254")"),
       {Priority::normal, MessageClass::message, to, {31, 254}},
       true,
       {7},
       {}},
      {"destination that agrees", with(R"(,"destination":"0.2")"), plain(to), false, {7}, {}},
      {"whole seconds",
       with(R"(,"timestamp":1436509052)"),
       plain(to),
       false,
       {7},
       1436509052000000000},
      {"1970", with(R"(,"timestamp":0)"), plain(to), false, {7}, 0},
      {"microseconds",
       with(R"(,"timestamp":1436509052.249713)"),
       plain(to),
       false,
       {7},
       1436509052249713000},
      {"nanoseconds",
       with(R"(,"timestamp":1436509052.249713001)"),
       plain(to),
       false,
       {7},
       1436509052249713001},
      {"digits below are cut off",
       with(R"(,"timestamp":0.1234567899999)"),
       plain(to),
       false,
       {7},
       123456789},
      {"exponent", with(R"(,"timestamp":1.5e3)"), plain(to), false, {7}, 1500000000000},
      {"exponent, rounded to microseconds",
       with(R"(,"timestamp":1436509052249713E-6)"),
       plain(to),
       false,
       {7},
       1436509052249713000},
      {"the latest time",
       with(R"(,"timestamp":9223372036.854775807)"),
       plain(to),
       false,
       {7},
       INT64_MAX},
  };
  for (const DecodeCase& row : cases) {
    expect_decoded(row);
  }
}

TEST(JsonDecode, LargestTextIsTaken) {
  const std::string message = with("");
  const auto longest = parse_json(message + std::string(4096 - message.size(), ' '));
  EXPECT_EQ(verdict(longest), "ok");
  const auto longer = parse_json(message + std::string(4097 - message.size(), ' '));
  ASSERT_EQ(verdict(longer), "JSON: 4097 bytes; expected at most 4096");
  EXPECT_EQ(longer.error().offset, 4096U);
}

}  // namespace
}  // namespace roio
