#include "input_line.hpp"

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
  return frame ? to_text(*frame) : "refused";
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
      "expected a JSON message {\"type\":\"Roio\",...} or a line of a log \"(TIME) BUS ID#DATA\"";
  for (const char* line : {"123#1122", "# note", "[]", "0.2 5A", " "}) {
    const auto frame = parse_input_line(line, from);
    ASSERT_FALSE(frame.ok()) << line;
    EXPECT_EQ(frame.error().message, expected);
  }
}
TEST(InputLine, AnErrorReportIsNoFrameToSend) {
  const auto frame = parse_input_line("(1.000000) can0 20000004#0001000000000000", from);
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.error().message, "expected a frame to send, found a controller's error report");
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
