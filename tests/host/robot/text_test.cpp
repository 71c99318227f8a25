// Values as people type and read them.
#include <gtest/gtest.h>

#include <roio/kind.hpp>
#include <string>

#include "parsing.hpp"
#include "robot/exact.hpp"

namespace roio {
namespace {

Field field_of(std::string_view rest) {
  const auto kind =
      parse_kind(R"({"roio": 1, "kind": "k", "hears": {"m": {"fields": [{"name": "a", )" +
                     std::string(rest) + "}]}}}",
                 "k");
  EXPECT_EQ(test::verdict(kind), "ok");
  return kind ? kind->heard.at(0).fields.at(0) : Field{};
}

/// What a typed value becomes, as it is read again.
std::string typed(const Field& field, std::string_view text) {
  const auto value = parse_value(field, text);
  if (!value) {
    return value.error().message;
  }
  const MessageKind message{"m", "", std::nullopt, {field}, 0, 8};
  const auto bytes = pack(message, {{"a", *value}});
  return bytes ? unpack(message, {bytes->data.data(), bytes->length})[0].text()
               : bytes.error().message;
}

TEST(Reading, Text) {
  const struct {
    Fraction scale;
    std::int64_t raw;
    const char* text;
    const char* why;
  } rows[] = {
      {{1, 1}, 90, "90", "whole"},
      {{1, 1}, -90, "-90", "negative"},
      {{1, 1}, 0, "0", "none"},
      {{1, 10}, 125, "12.5", "a decimal fraction"},
      {{1, 10}, -125, "-12.5", "negative"},
      {{1, 10}, 120, "12", "zeros behind the point are left out"},
      {{1, 10}, 3, "0.3", "a zero before it is not"},
      {{1, 10}, 0, "0", "none"},
      {{1, 1000000}, 4294967295, "4294.967295", "all digits"},
      {{1, 1000000}, 1, "0.000001", "the smallest step"},
      {{1000000, 1}, 4294967295, "4294967295000000", "the largest value"},
      {{1, 524288}, 1, "0.0000019073486328125", "exact, with 19 decimals"},
      {{999999, 524288}, -4294967295, "-8191991806.0926532745361328125", "and the most digits"},
      {{5, 2}, 3, "7.5", "a step above 1"},
      {{2, 4}, 1, "0.5", "a fraction that is not in its lowest terms"},
      {{3, 6}, 5, "2.5", "another: exact, though 6 has a 3 in it"},
      {{1, 3}, 1, "0.3", "not exact: as many digits as tell steps apart"},
      {{1, 3}, 2, "0.7", "rounded"},
      {{1, 3}, 3, "1", "whole again"},
      {{1, 3}, -2, "-0.7", "away from zero"},
      {{1, 7}, 3, "0.4", "sevenths are more than a tenth apart"},
      {{1, 11}, 3, "0.27", "elevenths are not"},
      {{4, 3}, 1, "1", "steps above 1 need no point"},
      {{4, 3}, 2, "3", "rounded"},
      {{1, 999999}, 1, "0.000001", "the smallest that is not exact"},
      {{1, 999999}, 500000, "0.500001", "and a larger one"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(robot_file::step_text(row.raw, row.scale), row.text) << row.why;
  }
}

TEST(Reading, ValueAndNames) {
  const Field field = field_of(R"("type": "enum", "values": {"off": 0, "on": 7})");
  EXPECT_EQ((Reading{&field, 7}.text()), "on");
  EXPECT_EQ((Reading{&field, 8}.text()), "8");
  EXPECT_EQ((Reading{&field, 7}.value()), 7.0);
  EXPECT_TRUE((Reading{&field, 7}.is_valid()));
  EXPECT_FALSE((Reading{&field, 8}.is_valid()));
  const Field temperature = field_of(R"("type": "i16", "scale": "1/10", "unit": "degC")");
  EXPECT_EQ((Reading{&temperature, -125}.value()), -12.5);
  EXPECT_EQ((Reading{&temperature, -125}.text()), "-12.5") << "without the unit";
}

TEST(Typed, Numbers) {
  const Field angle = field_of(R"("type": "u8", "unit": "deg", "maximum": 180)");
  const Field tenth = field_of(R"("type": "i16", "scale": "1/10", "unit": "V", "minimum": -10)");
  const Field third = field_of(R"("type": "i8", "scale": "1/3", "minimum": -1, "maximum": 1)");
  const struct {
    const Field& field;
    const char* text;
    const char* result;
  } rows[] = {
      {angle, "90", "90"},
      {angle, "0", "0"},
      {angle, "-0", "0"},
      {angle, "180", "180"},
      {angle, "90.0", "90"},
      {angle, "9e1", "90"},
      {angle, "1.8E+2", "180"},
      {angle, "18000000000000000000000000000e-26", "180"},
      {angle, "181", "a: 181 deg; expected a number 0..180 deg"},
      {angle, "180.5", "a: 180.5 deg; expected a number 0..180 deg"},
      {angle, "-1", "a: -1 deg; expected a number 0..180 deg"},
      {angle, "-0.5", "a: -0.5 deg; expected a number 0..180 deg"},
      {angle, "90.5", "a: 90.5 deg is between two steps; expected 90 or 91"},
      {angle, "1e400", "a: 1e400 deg; expected a number 0..180 deg"},
      {angle, "1e-400", "a: 1e-400 deg is between two steps; expected 0 or 1"},
      {angle, "", R"(a: ""; expected a number 0..180 deg)"},
      {angle, "ninety", R"(a: "ninety"; expected a number 0..180 deg)"},
      {angle, "+90", R"(a: "+90"; expected a number 0..180 deg)"},
      {angle, "090", R"(a: "090"; expected a number 0..180 deg)"},
      {angle, "0x5A", R"(a: "0x5A"; expected a number 0..180 deg)"},
      {angle, "90.", R"(a: "90."; expected a number 0..180 deg)"},
      {angle, ".5", R"(a: ".5"; expected a number 0..180 deg)"},
      {angle, "90 ", R"(a: "90 "; expected a number 0..180 deg)"},
      {angle, "90deg", R"(a: "90deg"; expected a number 0..180 deg)"},
      {angle, "1e", R"(a: "1e"; expected a number 0..180 deg)"},
      {angle, "nan", R"(a: "nan"; expected a number 0..180 deg)"},
      {angle, "99999999999999999999999999999999999999999999999999",
       R"(a: "999999999999999999999999999999999999999999999999..." (50 bytes) deg; expected a number 0..180 deg)"},
      {tenth, "12.5", "12.5"},
      {tenth, "-10", "-10"},
      {tenth, "-10.1", "a: -10.1 V; expected a number -10..3276.7 V"},
      {tenth, "0.30", "0.3"},
      {tenth, "0.34", "a: 0.34 V is between two steps; expected 0.3 or 0.4"},
      {tenth, "-0.34", "a: -0.34 V is between two steps; expected -0.4 or -0.3"},
      {tenth, "0.300000000000000000000000000000000001",
       "a: 0.300000000000000000000000000000000001 V is between two steps; expected 0.3 or 0.4"},
      {third, "1", "1"},
      {third, "0.3", "0.3"},
      {third, "0.7", "0.7"},
      {third, "-0.7", "-0.7"},
      {third, "0.33", "a: 0.33 is between two steps; expected 0 or 0.3"},
      {third, "0.5", "a: 0.5 is between two steps; expected 0.3 or 0.7"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(typed(row.field, row.text), row.result) << row.text;
  }
}

TEST(Typed, ChoicesAndBytes) {
  const Field gear = field_of(R"("type": "enum", "values": {"R": 255, "N": 0, "1": 1, "2": 5})");
  EXPECT_EQ(typed(gear, "R"), "R");
  EXPECT_EQ(typed(gear, "2"), "2") << "a name, though it is of digits";
  EXPECT_EQ(typed(gear, "5"), R"(a: "5"; expected one of R, N, 1, 2)");
  EXPECT_EQ(typed(gear, ""), R"(a: ""; expected one of R, N, 1, 2)");
  EXPECT_EQ(*parse_value(gear, "2")->choice(), "2");
  const Field grip = field_of(R"("type": "enum", "values": {"open": 0, "closed": 1})");
  EXPECT_EQ(typed(grip, "Closed"), R"(a: "Closed"; did you mean "closed"?)");
  const Field data = field_of(R"("type": "bytes", "minimum": 1, "maximum": 3)");
  EXPECT_EQ(typed(data, "5a.2d"), "5A2D");
  EXPECT_EQ(typed(data, ""), "a: 0 bytes; expected 1 to 3 bytes");
  EXPECT_EQ(typed(data, "01020304"), "a: 4 bytes; expected 1 to 3 bytes");
  EXPECT_EQ(typed(data, "5"), R"(a: data "5": odd number of hex digits; expected two per byte)");
}

}  // namespace
}  // namespace roio
