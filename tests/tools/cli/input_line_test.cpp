#include "form/input_line.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <roio/candump_log.hpp>
#include <string>
#include <thread>
#include <vector>

namespace roio::cli {
namespace {

constexpr Address from{0, 10};

std::string frame_of(std::string_view line) {
  const auto frame = parse_input_line(line, from);
  if (!frame) {
    return frame.error().message;
  }
  switch (frame->kind) {
    case InputLine::Kind::frame:
      return to_text(frame->frame);
    case InputLine::Kind::news:
      return "passed over";
    case InputLine::Kind::comment:
      break;
  }
  return "comment";
}

TEST(InputLine, JsonWithoutASourceGetsTheSendersOwn) {
  EXPECT_EQ(frame_of(R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,)"
                     R"("messageLength":3,"data":[90,45,0]})"),
            "1000400A#5A2D00");
}
TEST(InputLine, JsonWithASourceKeepsIt) {
  EXPECT_EQ(frame_of(R"(  {"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,)"
                     R"("data":[],"source":"0.3","priority":"urgent"})"),
            "001FE003#");
}
TEST(InputLine, ALogLineIsItsFrameOfWhateverKind) {
  EXPECT_EQ(frame_of("(1436509052.249713) vcan0 1000400A#5A2D00"), "1000400A#5A2D00");
  EXPECT_EQ(frame_of("(1436509052.249713) can1 123#R4\r"), "123#R4");
}

TEST(InputLine, OthersAreRefusedWithWhatWasExpected) {
  const char* const expected =
      "expected a JSON message {\"type\":\"Roio\",...}, a frame ID#DATA, or a line of a log "
      "\"(TIME) BUS ID#DATA\"";
  for (const char* line : {"[]", "0.2 5A", " ", "/ note", "-- note"}) {
    const auto frame = parse_input_line(line, from);
    ASSERT_FALSE(frame.ok()) << line;
    EXPECT_EQ(frame.error().message, expected);
  }
}
// To the JSON parser a zero byte is the end of the text, and a byte order mark nothing at all.
TEST(InputLine, AZeroByteOrAByteOrderMarkIsRefused) {
  const std::string message =
      R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,"data":[]})";
  const std::string other = R"({"type":"CAN","kind":"standard","id":291,"length":0,"data":[]})";
  const std::string news = R"({"type":"lost","frames":12})";
  for (const std::string& line :
       {message, other, news, std::string("123#11"), std::string("(1.0) can0 123#11")}) {
    EXPECT_EQ(frame_of(line + '\0' + "GARBAGE"),
              "a zero byte at byte " + std::to_string(line.size()) + "; expected text");
    EXPECT_EQ(frame_of("\xEF\xBB\xBF" + line),
              "begins with a byte order mark; expected text without one");
  }
}
TEST(InputLine, AFrameAsCansendTakesItIsTaken) {
  EXPECT_EQ(frame_of("1000400A#5A.2D.00"), "1000400A#5A2D00");
  EXPECT_EQ(frame_of(" 123#R4 \r"), "123#R4");
  EXPECT_EQ(frame_of("123##01122"),
            "frame \"123##01122\": a CAN FD frame (\"##\"); only classic CAN frames are taken");
  EXPECT_EQ(frame_of("123#1122 x"), "frame \"123#1122 x\": \" \" is no hex digit");
}

// What `dump --json` and `dump --log` write, and what stands between.
TEST(InputLine, JsonOfAnotherFrameIsThatFrame) {
  for (const auto& [line, text] : {
           std::pair{R"({"type":"CAN","kind":"standard","id":291,"length":2,"data":[17,34],)"
                     R"("timestamp":1436509052.249713})",
                     "123#1122"},
           std::pair{R"({"type":"CAN","kind":"standard-remote","id":2047,"length":4,"data":[]})",
                     "7FF#R4"},
           std::pair{R"({"type":"CAN","kind":"extended-remote","id":0,"length":0,"data":[]})",
                     "00000000#R"},
           std::pair{R"({"data":[],"length":0,"id":536870911,"kind":"extended","type":"CAN"})",
                     "1FFFFFFF#"},
       }) {
    EXPECT_EQ(frame_of(line), text);
  }
}
TEST(InputLine, WhatTellsOfTheBusIsPassedOver) {
  for (const char* line :
       {R"({"type":"lost","frames":12})", R"({"type":"state","state":"down"})",
        R"({"type":"CAN","kind":"error","id":4,"length":8,"data":[0,1,0,0,0,0,0,0]})",
        R"({"type":"CAN FD","frames":12})", "(1.000000) can0 20000004#0001000000000000",
        "(1.000000) can0 20000080#", "20000004#00",
        "DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)\r"}) {
    EXPECT_EQ(frame_of(line), "passed over") << line;
  }
}
TEST(InputLine, CommentsAreTold) {
  for (const char* line : {"# 123#11", "#123", " \t; of a log\r", "//", "// {}"}) {
    EXPECT_EQ(frame_of(line), "comment") << line;
  }
}
// The time is not looked at, so it takes no frame away.
TEST(InputLine, ALogLineIsTakenWhateverItsTime) {
  for (const char* time : {"0.0", "7", "7.", ".5", "-0.250000", "1436509052.2497131234",
                           "99999999999.0", "nan", "", "2015-07-10 08:17:32.249713"}) {
    EXPECT_EQ(frame_of(std::string("(") + time + ") can0 123#1122"), "123#1122") << time;
  }
  EXPECT_EQ(frame_of("(1.0 can0 123#"),
            "log line \"(1.0 can0 123#\": no ')' after the time; expected (SECONDS.FRACTION)");
}
TEST(InputLine, TheInterfaceIsTheLogs) {
  EXPECT_EQ(parse_input_line("(1.0) vcan7 123#", from)->interface_name, "vcan7");
  EXPECT_EQ(parse_input_line("123#", from)->interface_name, "");
}
TEST(InputLine, OfJsonTheBusIsTheInterface) {
  const std::string message =
      R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,"data":[])";
  const std::string other = R"({"type":"CAN","kind":"standard","id":291,"length":0,"data":[])";
  for (const std::string& line : {message, other}) {
    EXPECT_EQ(parse_input_line(line + R"(,"bus":"local:arm"})", from)->interface_name, "local:arm");
    EXPECT_EQ(parse_input_line(line + R"(,"timestamp":1.5,"bus":"a\"b}"})", from)->interface_name,
              "a\"b}");
    EXPECT_EQ(parse_input_line(line + "}", from)->interface_name, "");
  }
  // A bus is a text, and comes last.
  EXPECT_FALSE(parse_input_line(other + R"(,"bus":1})", from).ok());
  EXPECT_FALSE(parse_input_line(R"({"bus":"x",)" + other.substr(1) + "}", from).ok());
}
TEST(InputLine, ATimeIsToldWhereItCanBeRead) {
  const auto microseconds_of = [](const std::string& line) {
    const auto time = parse_input_line(line, from)->time;
    return time ? time->time_since_epoch().count() / 1000 : -1;
  };
  EXPECT_EQ(microseconds_of("(1436509052.249713) can0 123#"), 1436509052249713);
  EXPECT_EQ(microseconds_of("(0.0) can0 123#"), 0);
  EXPECT_EQ(microseconds_of("(-0.25) can0 123#"), -1);
  EXPECT_EQ(microseconds_of("(2015-07-10 08:17:32.249713) can0 123#"), -1);
  EXPECT_EQ(microseconds_of("123#"), -1);
  const std::string message =
      R"({"type":"Roio","isBroadcast":true,"subnet":0,"messageLength":0,"data":[])";
  const std::string other = R"({"type":"CAN","kind":"standard","id":291,"length":0,"data":[])";
  for (const std::string& line : {message, other}) {
    EXPECT_EQ(microseconds_of(line + R"(,"timestamp":1436509052.249713})"), 1436509052249713);
    EXPECT_EQ(microseconds_of(line + R"(,"timestamp":4000000000.999999})"),
              line == other ? -1 : 4000000000999999);
    EXPECT_EQ(microseconds_of(line + "}"), -1);
  }
}
TEST(InputLine, JsonOfAnotherFrameIsRefusedWithTheField) {
  for (const auto& [line, error] : {
           std::pair{R"({"type":"CAN","id":1,"length":0,"data":[]})",
                     R"(JSON field "kind": missing; a frame of type CAN has kind, id, length and )"
                     R"(data)"},
           std::pair{R"({"type":"CAN","kind":"fd","id":1,"length":0,"data":[]})",
                     R"(JSON field "kind": expected standard, standard-remote, extended, )"
                     R"(extended-remote or error)"},
           std::pair{R"({"type":"CAN","kind":"standard","id":2048,"length":0,"data":[]})",
                     R"(JSON field "id": expected an integer 0..2047)"},
           std::pair{R"({"type":"CAN","kind":"extended","id":-1,"length":0,"data":[]})",
                     R"(JSON field "id": expected an integer 0..536870911)"},
           std::pair{R"({"type":"CAN","kind":"standard","id":1,"length":9,"data":[]})",
                     R"(JSON field "length": expected an integer 0..8)"},
           std::pair{R"({"type":"CAN","kind":"standard","id":1,"length":1,"data":[]})",
                     R"(JSON field "data": expected an array of 1 byte, as kind and length say)"},
           std::pair{R"({"type":"CAN","kind":"standard-remote","id":1,"length":1,"data":[5]})",
                     R"(JSON field "data": expected an array of 0 bytes, as kind and length say)"},
           std::pair{R"({"type":"CAN","kind":"standard","id":1,"length":1,"data":[256]})",
                     R"(JSON field "data": expected integers 0..255)"},
           std::pair{R"({"type":"CAN","kind":"standard","id":1,"length":0,"data":[],"di":1})",
                     R"(JSON field "di": unknown in a frame of type CAN)"},
           std::pair{R"({"type":"CAN","type":"CAN","kind":"standard","id":1,"length":0,"data":[]})",
                     R"(JSON field "type": "CAN"; expected "Roio")"},
           std::pair{R"({"type":"lost"} x)", R"(JSON field "type": "lost"; expected "Roio")"},
           std::pair{R"({"type":"Lost"})", R"(JSON field "type": "Lost"; expected "Roio")"},
       }) {
    EXPECT_EQ(frame_of(line), error);
  }
}

TEST(InputLine, BlankIsWhiteSpaceOnly) {
  EXPECT_TRUE(is_blank(""));
  EXPECT_TRUE(is_blank(" \t\r"));
  EXPECT_FALSE(is_blank(" x"));
}

// All lines that a reader makes of a text which comes in pieces of this size.
std::vector<std::string> lines_of(const std::string& text, std::size_t piece) {
  std::array<int, 2> pipe{};
  EXPECT_EQ(::pipe(pipe.data()), 0);
  std::thread writer([&] {
    for (std::size_t at = 0; at < text.size(); at += piece) {
      const std::string part = text.substr(at, piece);
      EXPECT_EQ(::write(pipe[1], part.data(), part.size()), static_cast<ssize_t>(part.size()));
    }
    ::close(pipe[1]);
  });
  LineReader reader(pipe[0]);
  std::vector<std::string> lines;
  for (bool more = true; more;) {
    more = reader.fill();
    while (const auto line = reader.next()) {
      lines.emplace_back(*line);
    }
  }
  writer.join();
  ::close(pipe[0]);
  return lines;
}

using Lines = std::vector<std::string>;

TEST(LineReader, CutsLinesWhateverPiecesTheyComeIn) {
  for (const std::size_t piece : {1U, 2U, 3U, 100U}) {
    EXPECT_EQ(lines_of("one\n\nthree\n", piece), (Lines{"one", "", "three"}));
  }
}
TEST(LineReader, TheLastLineNeedsNoEnd) {
  EXPECT_EQ(lines_of("one\ntwo", 3), (Lines{"one", "two"}));
}
TEST(LineReader, NothingIsNoLine) {
  EXPECT_EQ(lines_of("", 1), Lines{});
}
TEST(LineReader, TheLongestLineComesWhole) {
  const std::string longest(LineReader::max_line, 'x');
  EXPECT_EQ(lines_of(longest + "\nnext\n", 5000), (Lines{longest, "next"}));
}
TEST(LineReader, ALineTooLongIsReportedOnceAndTheNextOneIsRead) {
  const std::string text = std::string(10 * LineReader::max_line, 'x') + "\nnext\n";
  const Lines lines = lines_of(text, 5000);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_GT(lines[0].size(), LineReader::max_line);
  EXPECT_EQ(lines[1], "next");
  const auto frame = parse_input_line(lines[0], from);
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.error().message, "expected a line of at most 65536 bytes");
}

}  // namespace
}  // namespace roio::cli
