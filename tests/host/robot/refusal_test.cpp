// What is refused, in which words: the tables in refusals/, and what a line of text cannot hold.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <roio/robot.hpp>
#include <string>

#include "folder.hpp"
#include "parsing.hpp"
#include "refusals.hpp"

namespace roio {
namespace {

using test::broken_files;
using test::BrokenFile;
using test::source_dir;
using test::verdict;

class RobotRefusal : public test::RobotFolder {};

TEST(KindRefusal, Table) {
  for (const BrokenFile& row : broken_files("kind.txt")) {
    EXPECT_EQ(verdict(parse_kind(row.text, "servo-arm.kind.json")), row.error) << row.why;
  }
}

TEST_F(RobotRefusal, Table) {
  std::filesystem::create_directory("kinds");
  std::filesystem::copy(source_dir / "kinds/servo-arm.kind.json", "kinds");
  std::filesystem::copy(source_dir / "tests/host/robot/refusals/motor.kind.json", "kinds");
  for (const BrokenFile& row : broken_files("robot.txt")) {
    write("robot.json", row.text);
    EXPECT_EQ(verdict(load_robot("robot.json", {{"/elsewhere"}})), row.error) << row.why;
  }
}

TEST(KindRefusal, OffsetIsThatOfTheValue) {
  const std::string text = "{\"roio\": 1,\n \"kind\": \"k\", \"hears\": {\"m\": {\"tag\": 256}}}";
  const auto kind = parse_kind(text, "k");
  ASSERT_FALSE(kind);
  EXPECT_EQ(kind.error().offset, text.find("\": 256"));
}

TEST(KindRefusal, WhatIsNoText) {
  const std::string good = R"({"roio": 1, "kind": "k"})";
  const struct {
    const char* why;
    std::string text;
    std::string error;
  } rows[] = {
      {"good", good, "ok"},
      {"a zero byte behind it", good + '\0' + "garbage", "k:1: a zero byte; expected text"},
      {"a zero byte in it", "\n" + std::string("{\0}", 3), "k:2: a zero byte; expected text"},
      {"a zero byte by an escape", R"({"roio": 1, "kind": "k\u0000"})",
       R"(k:1: kind: "k\x00"; expected a name of 1 to 32 letters, digits, - and _, a letter first)"},
      {"a byte order mark", "\xEF\xBB\xBF" + good, "k:1: a byte order mark; expected none"},
      {"Latin-1", "{\"roio\": 1, \"kind\": \"k\",\n\"description\": \"\xE9\"}",
       R"(k:2: "\xE9" is not UTF-8)"},
      {"half a surrogate", "{\"roio\": 1, \"kind\": \"\xED\xA0\x80\"}",
       R"(k:1: "\xED" is not UTF-8)"},
      {"UTF-16", std::string("\xFF\xFE{\0", 4), R"(k:1: "\xFF" is not UTF-8)"},
      {"as long as it may be", good + std::string(1048576 - good.size(), ' '), "ok"},
      {"a byte longer", good + std::string(1048577 - good.size(), ' '),
       "k: 1048577 bytes; expected at most 1048576"},
      {"lines that end as on Windows", "{\r\n\"roio\": 1,\r\n\"kind\": 1}",
       "k:3: kind: 1; expected a name of 1 to 32 letters, digits, - and _, a letter first"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(verdict(parse_kind(row.text, "k")), row.error) << row.why;
  }
}

TEST(KindRefusal, AFileWhoseNameWouldBreakTheLine) {
  EXPECT_EQ(verdict(parse_kind("[]", "a\nb.kind.json")),
            R"("a\nb.kind.json":1: an array; expected an object)");
  EXPECT_EQ(verdict(parse_kind("[]", "bras-\xC3\xA9.kind.json")),
            "bras-\xC3\xA9.kind.json:1: an array; expected an object");
}

// The worst that fits in a file: nothing here takes longer than reading it.
TEST(KindRefusal, LargeFilesCostNoMoreThanTheirSize) {
  std::string twins = R"({"roio": 1, "kind": "k", "says": {)";
  std::string fields;
  for (int i = 0; i < 90000; ++i) {
    twins += "\"m" + std::to_string(i) + "\":0,";
    fields += R"({"a":0},)";
  }
  EXPECT_EQ(verdict(parse_kind(twins + R"("m1":0}})", "k")),
            "k:1: says.m1: given twice; expected once");
  fields.pop_back();
  EXPECT_EQ(verdict(parse_kind(R"({"roio": 1, "kind": "k", "settings": [)" + fields + "]}", "k")),
            "k:1: settings: 90000 settings; expected at most 100");
  EXPECT_EQ(verdict(parse_kind(std::string(500000, '['), "k")),
            "k:1: [0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0]: too deep; "
            "expected at most 16 objects and arrays in each other");
}

TEST_F(RobotRefusal, FilesThatCannotBeRead) {
  write("servo.json", "{}");
  write("fan.kind.json", R"({"roio": 1, "kind": "servo-arm"})");
  write(".kind.json", "{}");
  write("large.kind.json", std::string(1048577, ' '));
  std::filesystem::create_directory("folder.kind.json");
  ASSERT_EQ(::mkfifo("pipe.kind.json", 0600), 0);
  std::filesystem::create_symlink("loop.kind.json", "loop.kind.json");
  const struct {
    const char* file;
    const char* error;
  } rows[] = {
      {"none.kind.json", "none.kind.json: No such file or directory"},
      {"servo.json", "servo.json: not called as a kind's file is; expected NAME.kind.json"},
      {".kind.json", ".kind.json: not called as a kind's file is; expected NAME.kind.json"},
      {"folder.kind.json", "folder.kind.json: a folder; expected a file"},
      {"pipe.kind.json", "pipe.kind.json: no ordinary file; expected one"},
      {"loop.kind.json", "loop.kind.json: Too many levels of symbolic links"},
      {"large.kind.json", "large.kind.json: more than 1048576 bytes; expected at most so many"},
      {"fan.kind.json",
       R"(fan.kind.json:1: kind: "servo-arm"; expected "fan", as the file is called)"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(verdict(load_kind(row.file)), row.error);
  }
  EXPECT_EQ(verdict(load_robot("none.json")), "none.json: No such file or directory");
  EXPECT_EQ(verdict(load_robot("folder.kind.json")), "folder.kind.json: a folder; expected a file");
}

}  // namespace
}  // namespace roio
