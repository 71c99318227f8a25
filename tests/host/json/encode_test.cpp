#include <gtest/gtest.h>

#include <roio/json.hpp>

#include "parsing.hpp"
#include "seed.hpp"

namespace roio {
namespace {

using test::verdict;

Timestamp at_ns(std::int64_t ns) {
  return Timestamp(std::chrono::nanoseconds(ns));
}

struct EncodeCase {
  const char* why;
  JsonMessage message;
  const char* text;
};

TEST(JsonEncode, OneLineInTheOriginalsOrder) {
  const EncodeCase cases[] = {
      {"the original's",
       {{{Priority::normal, MessageClass::message, {10, 25}, {}}, 4, {10, 20, 30, 40}}, false, {}},
       R"({"type":"Roio","isBroadcast":false,"address":25,"subnet":10,"messageLength":4,)"
       R"("data":[10,20,30,40]})"},
      {"broadcast without data",
       {{{Priority::normal, MessageClass::message, {0, 255}, {}}, 0, {}}, false, {}},
       R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,"data":[]})"},
      {"everything",
       {{{Priority::urgent, MessageClass::system, {31, 254}, {3, 4}}, 1, {255}},
        true,
        at_ns(1436509052249713999)},
       R"({"type":"Roio","isBroadcast":false,"address":254,"subnet":31,"messageLength":1,)"
       R"("data":[255],"priority":"urgent","class":"system","source":"3.4",)"
       R"("timestamp":1436509052.249713})"},
      {"a source that is not given is not written",
       {{{Priority::normal, MessageClass::stream, {0, 0}, {3, 4}}, 0, {}}, false, {}},
       R"({"type":"Roio","isBroadcast":false,"address":0,"subnet":0,"messageLength":0,"data":[],)"
       R"("class":"stream"})"},
      {"1970",
       {{{Priority::normal, MessageClass::message, {0, 255}, {}}, 0, {}}, false, at_ns(0)},
       R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,"data":[],)"
       R"("timestamp":0.000000})"},
      {"before 1970",
       {{{Priority::normal, MessageClass::message, {0, 255}, {}}, 0, {}}, false, at_ns(-1)},
       R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,"data":[],)"
       R"("timestamp":0.000000})"},
      {"more bytes than there are",
       {{{Priority::normal, MessageClass::message, {0, 255}, {}}, 9, {1, 2, 3, 4, 5, 6, 7, 8}},
        false,
        {}},
       R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":8,)"
       R"("data":[1,2,3,4,5,6,7,8]})"},
  };
  for (const EncodeCase& row : cases) {
    EXPECT_EQ(to_json(row.message), row.text) << row.why;
  }
}

bool flip(std::mt19937& generator) {
  return test::up_to(generator, 1) == 1;
}

std::uint8_t up_to_u8(std::mt19937& generator, std::uint32_t max) {
  return static_cast<std::uint8_t>(test::up_to(generator, max));
}

JsonMessage random_message(std::mt19937& generator) {
  JsonMessage out;
  Message& message = out.message;
  message.header.priority = flip(generator) ? Priority::urgent : Priority::normal;
  message.header.message_class = static_cast<MessageClass>(test::up_to(generator, 2));
  message.header.destination = {up_to_u8(generator, max_subnet),
                                up_to_u8(generator, broadcast_node)};
  out.has_source = flip(generator);
  if (out.has_source) {
    message.header.source = {up_to_u8(generator, max_subnet), up_to_u8(generator, max_node)};
  }
  message.length = up_to_u8(generator, max_data_length);
  for (std::uint8_t i = 0; i < message.length; ++i) {
    message.data[i] = up_to_u8(generator, 0xFF);
  }
  if (flip(generator)) {
    std::uniform_int_distribution<std::int64_t> any_us(0, INT64_MAX / 1000);
    out.time = at_ns(any_us(generator) * 1000);
  }
  return out;
}

void expect_comes_back(const JsonMessage& message) {
  const std::string text = to_json(message);
  const auto parsed = parse_json(text);
  ASSERT_EQ(verdict(parsed), "ok") << text;
  EXPECT_EQ(parsed->message.header, message.message.header) << text;
  EXPECT_EQ(parsed->message.length, message.message.length) << text;
  EXPECT_TRUE(std::equal(message.message.data, message.message.data + max_data_length,
                         parsed->message.data))
      << text;
  EXPECT_EQ(parsed->has_source, message.has_source) << text;
  EXPECT_EQ(parsed->time, message.time) << text;
  EXPECT_EQ(to_json(*parsed), text);
}

TEST(JsonEncode, RandomMessagesComeBack) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 10000; ++i) {
    expect_comes_back(random_message(generator));
  }
}

}  // namespace
}  // namespace roio
