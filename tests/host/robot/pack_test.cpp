// From names to bytes and back: bytes from the document's rules, not from the code.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <roio/kind.hpp>
#include <string>

#include "parsing.hpp"

namespace roio {
namespace {

/// The message "m" of a kind that hears it.
MessageKind message_of(std::string_view fields, const std::string& tag = "") {
  const auto kind = parse_kind(R"({"roio": 1, "kind": "k", "hears": {"m": {)" + tag +
                                   R"("fields": [)" + std::string(fields) + "]}}}",
                               "k");
  EXPECT_EQ(test::verdict(kind), "ok");
  return kind ? kind->heard.at(0) : MessageKind{};
}

std::string packed(const MessageKind& message, std::initializer_list<NamedValue> values) {
  const auto bytes = pack(message, values);
  return bytes ? to_hex(bytes->data.data(), bytes->length) : bytes.error().message;
}

std::string unpacked(const MessageKind& message, std::string_view hex) {
  const Bytes bytes = *parse_hex(hex);
  std::string out;
  for (const Reading& reading : unpack(message, {bytes.data.data(), bytes.length})) {
    out += (out.empty() ? "" : " ") + reading.field->name + '=' + reading.text() +
           (reading.is_valid() ? "" : "!");
  }
  return out;
}

struct Corner {
  const char* type;
  double value;
  const char* bytes;  ///< Or why not.
};

TEST(Pack, TypesAtTheirCorners) {
  const Corner rows[] = {
      {"u8", 0, "00"},
      {"u8", 255, "FF"},
      {"u8", 256, "m.a: 256; expected a number 0..255"},
      {"u8", -1, "m.a: -1; expected a number 0..255"},
      {"u16", 258, "0102"},
      {"u16", 65535, "FFFF"},
      {"u16", 65536, "m.a: 65536; expected a number 0..65535"},
      {"u24", 0x010203, "010203"},
      {"u24", 16777215, "FFFFFF"},
      {"u24", 16777216, "m.a: 16777216; expected a number 0..16777215"},
      {"u32", 0x01020304, "01020304"},
      {"u32", 4294967295.0, "FFFFFFFF"},
      {"u32", 4294967296.0, "m.a: 4294967296; expected a number 0..4294967295"},
      {"i8", -128, "80"},
      {"i8", -1, "FF"},
      {"i8", 127, "7F"},
      {"i8", 128, "m.a: 128; expected a number -128..127"},
      {"i8", -129, "m.a: -129; expected a number -128..127"},
      {"i16", -2, "FFFE"},
      {"i16", -32768, "8000"},
      {"i16", 32767, "7FFF"},
      {"i24", -1, "FFFFFF"},
      {"i24", -8388608, "800000"},
      {"i24", 8388607, "7FFFFF"},
      {"i24", 8388608, "m.a: 8388608; expected a number -8388608..8388607"},
      {"i24", -8388609, "m.a: -8388609; expected a number -8388608..8388607"},
      {"i32", -2147483648.0, "80000000"},
      {"i32", 2147483647, "7FFFFFFF"},
      {"i32", 2147483648.0, "m.a: 2147483648; expected a number -2147483648..2147483647"},
      {"bits", 1, "80"},
      {"bits", 2, "m.a: 2; expected a number 0..1"},
      {"u8", 1e300, "m.a: 1e+300; expected a number 0..255"},
      {"i32", -1e300, "m.a: -1e+300; expected a number -2147483648..2147483647"},
      {"u8", std::numeric_limits<double>::infinity(), "m.a: inf; expected a number 0..255"},
      {"u8", -std::numeric_limits<double>::infinity(), "m.a: -inf; expected a number 0..255"},
      {"u8", std::nan(""), "m.a: nan; expected a number 0..255"},
  };
  for (const Corner& row : rows) {
    const auto message = message_of(R"({"name": "a", "type": ")" + std::string(row.type) + R"("})");
    EXPECT_EQ(packed(message, {{"a", row.value}}), row.bytes) << row.type;
    if (std::string_view(row.bytes).substr(0, 2) != "m.") {
      const Bytes bytes = *parse_hex(row.bytes);
      const auto readings = unpack(message, {bytes.data.data(), bytes.length});
      ASSERT_EQ(readings.size(), 1U);
      EXPECT_EQ(readings[0].value(), row.value) << row.type;
      EXPECT_TRUE(readings[0].is_valid());
    }
  }
}

TEST(Pack, BitsShareBytesFromTheHighestDown) {
  const auto message = message_of(R"(
      {"name": "a", "type": "bits"}, {"name": "b", "type": "bits", "width": 3},
      {"name": "c", "type": "enum", "width": 2, "values": {"off": 0, "on": 3}},
      {"name": "d", "type": "bits", "width": 3}, {"name": "e", "type": "u16"})");
  // a bbb cc .. | ddd ..... | e
  EXPECT_EQ(packed(message, {{"a", 1}, {"b", 5}, {"c", "on"}, {"d", 6}, {"e", 0x1234}}),
            "DCC01234");
  EXPECT_EQ(packed(message, {{"e", 0}, {"d", 0}, {"c", "off"}, {"b", 7}, {"a", 0}}), "70000000")
      << "the order of values does not matter";
  EXPECT_EQ(unpacked(message, "DCC01234"), "a=1 b=5 c=on d=6 e=4660");
  EXPECT_EQ(unpacked(message, "DFDF1234"), "a=1 b=5 c=on d=6 e=4660")
      << "bits of no field are not looked at";
}

TEST(Pack, TheTagIsTheFirstByte) {
  const auto message = message_of(R"({"name": "a", "type": "u8"})", R"("tag": 171, )");
  EXPECT_EQ(packed(message, {{"a", 1}}), "AB01");
  EXPECT_EQ(unpacked(message, "AB07"), "a=7");
  EXPECT_EQ(unpacked(message, "AA07"), "") << "not such a message";
  EXPECT_EQ(unpacked(message, "AB"), "") << "not such a message";
}

TEST(Pack, BytesAreAllThatIsLeft) {
  const auto message = message_of(R"({"name": "n", "type": "u8"},
                                     {"name": "data", "type": "bytes", "minimum": 1, "maximum": 3})");
  EXPECT_EQ(packed(message, {{"n", 9}, {"data", *parse_hex("01")}}), "0901");
  EXPECT_EQ(packed(message, {{"n", 9}, {"data", *parse_hex("010203")}}), "09010203");
  EXPECT_EQ(packed(message, {{"n", 9}, {"data", *parse_hex("01020304")}}),
            "m.data: 4 bytes; expected 1 to 3 bytes");
  EXPECT_EQ(packed(message, {{"n", 9}, {"data", Bytes{}}}),
            "m.data: 0 bytes; expected 1 to 3 bytes");
  EXPECT_EQ(packed(message, {{"n", 9}}), "m.data: missing; expected 1 to 3 bytes");
  EXPECT_EQ(unpacked(message, "09AABBCC"), "n=9 data=AABBCC");
  const auto any = message_of(R"({"name": "data", "type": "bytes"})");
  EXPECT_EQ(packed(any, {}), "") << "none may be left out";
  EXPECT_EQ(packed(any, {{"data", *parse_hex("0102030405060708")}}), "0102030405060708");
  EXPECT_EQ(unpacked(any, ""), "data=");
}

TEST(Pack, RoundsToTheNearestStep) {
  const struct {
    const char* scale;
    double value;
    const char* bytes;
  } rows[] = {{R"("1/10")", 12.3, "007B"},
              {R"("1/10")", 0.3, "0003"},
              {R"("1/10")", 0.04, "0000"},
              {R"("1/10")", 0.06, "0001"},
              {R"("1/10")", -0.06, "FFFF"},
              {R"("1/2")", 0.25, "0001"},
              {R"("1/2")", -0.25, "FFFF"},
              {R"("1/2")", 0.2499, "0000"},
              {"10", 14.9, "0001"},
              {"10", 15, "0002"},
              {"10", -15, "FFFE"},
              {"1", 0.5, "0001"},
              {"1", 1.5, "0002"},
              {"1", -2.5, "FFFD"},
              {"1", 2.4999, "0002"},
              {R"("2/3")", 2, "0003"},
              {R"("2/3")", 1.01, "0002"},
              {R"("1/3")", 1, "0003"},
              {R"("1/10")", 3276.74, "7FFF"}};
  for (const auto& row : rows) {
    const auto message =
        message_of(R"({"name": "a", "type": "i16", "scale": )" + std::string(row.scale) + '}');
    EXPECT_EQ(packed(message, {{"a", row.value}}), row.bytes) << row.scale << ' ' << row.value;
  }
  EXPECT_EQ(packed(message_of(R"({"name": "a", "type": "i16", "scale": "1/10", "unit": "V"})"),
                   {{"a", 3276.75}}),
            "m.a: 3276.75 V; expected a number -3276.8..3276.7 V")
      << "half a step past is a step past";
}

TEST(Pack, NamesAreCheckedFirst) {
  const auto message =
      message_of(R"({"name": "shoulder", "type": "u8", "unit": "deg", "maximum": 180},
      {"name": "grip", "type": "enum", "values": {"open": 0, "closed": 1}},
      {"name": "only", "type": "enum", "values": {"this": 0}})");
  EXPECT_EQ(packed(message, {{"sholder", 1}}),
            R"(m.sholder: no such field; did you mean "shoulder"?)");
  EXPECT_EQ(packed(message, {{"x", 1}}),
            "m.x: no such field; expected one of shoulder, grip, only");
  EXPECT_EQ(packed(message, {{"shoulder", 1}, {"shoulder", 2}}),
            "m.shoulder: given twice; expected once");
  EXPECT_EQ(packed(message, {{"shoulder", 1}}), "m.grip: missing; expected one of open, closed");
  EXPECT_EQ(packed(message, {}), "m.shoulder: missing; expected a number 0..180 deg");
  EXPECT_EQ(packed(message, {{"shoulder", "90"}, {"grip", "open"}, {"only", "this"}}),
            R"(m.shoulder: "90"; expected a number 0..180 deg)");
  EXPECT_EQ(packed(message, {{"shoulder", Bytes{}}, {"grip", "open"}, {"only", "this"}}),
            "m.shoulder: 0 bytes; expected a number 0..180 deg");
  EXPECT_EQ(packed(message, {{"shoulder", 1}, {"grip", 1}, {"only", "this"}}),
            "m.grip: 1; expected one of open, closed");
  EXPECT_EQ(packed(message, {{"shoulder", 1}, {"grip", "opne"}, {"only", "this"}}),
            R"(m.grip: "opne"; did you mean "open"?)");
  EXPECT_EQ(packed(message, {{"shoulder", 1}, {"grip", "open"}, {"only", "that"}}),
            R"(m.only: "that"; expected this)");
  EXPECT_EQ(
      packed(message, {{"shoulder", true}, {"grip", std::string("closed")}, {"only", "this"}}),
      "010100");
  const MessageKind empty{"nothing", "", std::nullopt, {}, 0, 0};
  EXPECT_EQ(packed(empty, {{"a", 1}}), "nothing.a: no such field; expected none: it is empty");
  EXPECT_EQ(packed(empty, {}), "");
}

TEST(Unpack, ShowsWhatABoardShouldNotSend) {
  const auto message = message_of(R"({"name": "angle", "type": "u8", "maximum": 180},
      {"name": "low", "type": "i8", "minimum": -10},
      {"name": "grip", "type": "enum", "values": {"open": 0, "closed": 1}})");
  EXPECT_EQ(unpacked(message, "B4F601"), "angle=180 low=-10 grip=closed");
  EXPECT_EQ(unpacked(message, "B5F502"), "angle=181! low=-11! grip=2!");
}

}  // namespace
}  // namespace roio
