#include "form/record_format.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <roio/json.hpp>
#include <string>

namespace roio::cli {
namespace {

Received received(std::uint32_t id, FrameKind kind) {
  return {
      {id, kind, 3, {0x5A, 0x2D, 0x00}}, Timestamp(std::chrono::microseconds(1436509052249713)), 0};
}

std::string written(RecordFormat& format) {
  Buffer out;
  format.frame(out, received(0x1000400A, FrameKind::extended));
  format.lost(out, 1);
  format.lost(out, 12);
  format.not_shown(out, 1);
  format.not_shown(out, 2);
  format.state(out, BusState::down);
  format.frame(out, received(0x123, FrameKind::standard));
  return {out.data(), out.size()};
}

TEST(RecordFormat, TextSaysInLineWhatHappened) {
  EXPECT_EQ(written(*text_format(TimeColumn::Mode::zero, false)),
            "(000.000000) 0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
            "! 1 frame lost\n"
            "! 12 frames lost\n"
            "! 1 CAN FD frame not shown\n"
            "! 2 CAN FD frames not shown\n"
            "! bus is down\n"
            "(000.000000) foreign  11-bit 123                [3]  5A 2D 00\n");
}

TEST(RecordFormat, TextInColourMarksWhatHappened) {
  Buffer out;
  text_format(TimeColumn::Mode::none, true)->lost(out, 2);
  EXPECT_EQ(std::string(out.data(), out.size()), "\033[1;31m! 2 frames lost\033[0m\n");
}

TEST(RecordFormat, LogKeepsStandardOutputForFramesAlone) {
  const auto format = log_format("vcan0");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::string rest = written(*format);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "(1436509052.249713) vcan0 1000400A#5A2D00\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "roio-cli: vcan0: 1 frame lost\n"
            "roio-cli: vcan0: 12 frames lost\n"
            "roio-cli: vcan0: 1 CAN FD frame not shown\n"
            "roio-cli: vcan0: 2 CAN FD frames not shown\n"
            "roio-cli: vcan0: bus is down\n");
  EXPECT_EQ(rest, "(1436509052.249713) vcan0 123#5A2D00\n");
}

TEST(RecordFormat, JsonIsOneObjectALine) {
  EXPECT_EQ(
      written(*json_format()),
      R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":3,"data":[90,45,0],"source":"0.10","timestamp":1436509052.249713})"
      "\n"
      R"({"type":"lost","frames":1})"
      "\n"
      R"({"type":"lost","frames":12})"
      "\n"
      R"({"type":"CAN FD","frames":1})"
      "\n"
      R"({"type":"CAN FD","frames":2})"
      "\n"
      R"({"type":"state","state":"down"})"
      "\n"
      R"({"type":"CAN","kind":"standard","id":291,"length":3,"data":[90,45,0],"timestamp":1436509052.249713})"
      "\n");
}

TEST(RecordFormat, JsonOfAMessageIsReadBackAsTheSameMessage) {
  Buffer out;
  json_format()->frame(out, received(0x0400400A, FrameKind::extended));
  const auto json = parse_json({out.data(), out.size() - 1});
  ASSERT_TRUE(json.ok()) << json.error().message;
  EXPECT_EQ(json->message.header,
            (Header{Priority::urgent, MessageClass::system, {0, 2}, {0, 10}}));
}

TEST(RecordFormat, JsonOfARemoteRequestHasALengthAndNoData) {
  Buffer out;
  json_format()->frame(out, received(0x123, FrameKind::standard_remote));
  EXPECT_EQ(std::string(out.data(), out.size()),
            R"({"type":"CAN","kind":"standard-remote","id":291,"length":3,"data":[],)"
            R"("timestamp":1436509052.249713})"
            "\n");
}

}  // namespace
}  // namespace roio::cli
