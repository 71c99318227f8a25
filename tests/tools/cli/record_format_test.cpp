#include "form/record_format.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <roio/json.hpp>
#include <string>
#include <vector>

#include "form/json_lines.hpp"
#include "form/origin.hpp"

namespace roio::cli {
namespace {

Received received(std::uint32_t id, FrameKind kind) {
  return {
      {id, kind, 3, {0x5A, 0x2D, 0x00}}, Timestamp(std::chrono::microseconds(1436509052249713)), 0};
}

const Origin from_robot{"local:robot", "robot"};

// All that may happen, between two frames.
std::string written(RecordFormat& format) {
  Buffer out;
  format.begin(out);
  format.frame(out, from_robot, received(0x1000400A, FrameKind::extended));
  for (const BusNews& news :
       {BusNews{BusNews::Kind::lost, 1}, BusNews{BusNews::Kind::lost, 12},
        BusNews{BusNews::Kind::not_shown, 1}, BusNews{BusNews::Kind::not_shown, 2},
        BusNews{BusNews::Kind::state, 0, BusState::down}}) {
    const std::size_t before = out.size();
    const bool written = format.news(out, from_robot, news);
    EXPECT_EQ(written, out.size() != before) << to_text(news);
  }
  format.frame(out, from_robot, received(0x123, FrameKind::standard));
  return {out.data(), out.size()};
}

TextStyle style(TimeColumn::Mode time, Colour colour = Colour::none, std::size_t bus_width = 0) {
  return {time, colour, bus_width};
}

TEST(RecordFormat, TextSaysInLineWhatHappened) {
  EXPECT_EQ(written(*text_format(style(TimeColumn::Mode::zero))),
            "(000.000000) 0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
            "! 1 frame lost\n"
            "! 12 frames lost\n"
            "! 1 CAN FD frame not shown\n"
            "! 2 CAN FD frames not shown\n"
            "! bus is down\n"
            "(000.000000) foreign  11-bit 123                [3]  5A 2D 00\n");
}

TEST(RecordFormat, TextOfSeveralBusesHasAColumnForThem) {
  EXPECT_EQ(written(*text_format(style(TimeColumn::Mode::none, Colour::none, 7))),
            "robot   0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
            "! robot: 1 frame lost\n"
            "! robot: 12 frames lost\n"
            "! robot: 1 CAN FD frame not shown\n"
            "! robot: 2 CAN FD frames not shown\n"
            "! robot: bus is down\n"
            "robot   foreign  11-bit 123                [3]  5A 2D 00\n");
}

TEST(RecordFormat, TextInColourMarksWhatHappened) {
  Buffer out;
  text_format(style(TimeColumn::Mode::none, Colour::kinds))
      ->news(out, from_robot, {BusNews::Kind::lost, 2});
  EXPECT_EQ(std::string(out.data(), out.size()), "\033[1;31m! 2 frames lost\033[0m\n");
}

TEST(RecordFormat, LogHasFramesAlone) {
  EXPECT_EQ(written(*log_format()),
            "(1436509052.249713) robot 1000400A#5A2D00\n"
            "(1436509052.249713) robot 123#5A2D00\n");
}

TEST(RecordFormat, CsvHasFramesAloneUnderALineOfNames) {
  EXPECT_EQ(
      written(*csv_format()),
      "time,bus,kind,id,priority,class,source_subnet,source_node,destination_subnet,"
      "destination_node,length,d0,d1,d2,d3,d4,d5,d6,d7\n"
      "1436509052.249713,local:robot,extended,0x1000400A,normal,message,0,10,0,2,3,90,45,0,,,,,"
      "\n"
      "1436509052.249713,local:robot,standard,0x123,,,,,,,3,90,45,0,,,,,\n");
}

TEST(RecordFormat, CsvHasAsManyColumnsForEveryFrame) {
  const Timestamp time{};
  for (const Frame& frame :
       {Frame{0x123, FrameKind::standard_remote, 8, {}}, Frame{0, FrameKind::standard, 0, {}},
        Frame{0x1FFFFFFF, FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
        Frame{0x40, FrameKind::error, 8, {}}, Frame{0x1000400A, FrameKind::extended, 8, {}}}) {
    Buffer out;
    csv_format()->frame(out, from_robot, {frame, time, 0});
    const std::string line(out.data(), out.size());
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 18) << line;
  }
}

TEST(RecordFormat, CsvQuotesAPathThatHoldsWhatSeparates) {
  Buffer out;
  csv_format()->frame(out, {"serial:/dev/a,\"b", "x"}, received(0x123, FrameKind::standard));
  EXPECT_EQ(std::string(out.data(), out.size()),
            "1436509052.249713,\"serial:/dev/a,\"\"b\",standard,0x123,,,,,,,3,90,45,0,,,,,\n");
}

// The bytes as they stand in the documents that pcap_format.cpp names.
TEST(RecordFormat, PcapIsTheHeaderAndARecordForEachFrame) {
  using namespace std::string_literals;
  static_assert(std::endian::native == std::endian::little,
                "the bytes here are those of such a one");
  EXPECT_EQ(written(*pcap_format()),
            "\x4D\x3C\xB2\xA1\x02\0\x04\0\0\0\0\0\0\0\0\0\xFF\xFF\0\0\xE3\0\0\0"s +
                // seconds, nanoseconds, kept, there was
                "\x7C\x63\x9F\x55\x68\x51\xE2\x0E\x0B\0\0\0\x0B\0\0\0"s +
                "\x90\x00\x40\x0A\x03\0\0\0\x5A\x2D\0"s +
                "\x7C\x63\x9F\x55\x68\x51\xE2\x0E\x0B\0\0\0\x0B\0\0\0"s +
                "\x00\x00\x01\x23\x03\0\0\0\x5A\x2D\0"s);
}

TEST(RecordFormat, PcapOfARemoteRequestHasALengthAndNoData) {
  using namespace std::string_literals;
  Buffer out;
  pcap_format()->frame(out, from_robot, received(0x123, FrameKind::standard_remote));
  EXPECT_EQ(std::string(out.data() + 8, out.size() - 8),
            "\x08\0\0\0\x08\0\0\0\x40\x00\x01\x23\x03\0\0\0"s);
}

constexpr const char* json_lines[] = {
    R"({"type":"Roio","isBroadcast":false,"address":2,"subnet":0,"messageLength":3,"data":[90,45,0],"source":"0.10","timestamp":1436509052.249713)",
    R"({"type":"lost","frames":1)",
    R"({"type":"lost","frames":12)",
    R"({"type":"CAN FD","frames":1)",
    R"({"type":"CAN FD","frames":2)",
    R"({"type":"state","state":"down")",
    R"({"type":"CAN","kind":"standard","id":291,"length":3,"data":[90,45,0],"timestamp":1436509052.249713)",
};

TEST(RecordFormat, JsonIsOneObjectALine) {
  std::string alone;
  std::string of_several;
  for (const std::string line : json_lines) {
    alone += line + "}\n";
    of_several += line + R"(,"bus":"local:robot"})" + "\n";
  }
  EXPECT_EQ(written(*json_format(false)), alone);
  EXPECT_EQ(written(*json_format(true)), of_several);
}

TEST(RecordFormat, JsonOfSeveralBusesIsReadBack) {
  for (const std::string line : json_lines) {
    const auto frame = parse_json_line(line + R"(,"bus":"local:robot"})", {0, 1});
    ASSERT_TRUE(frame) << frame.error().message;
    EXPECT_EQ(frame->has_value(), line.find("data") != std::string::npos) << line;
  }
  for (const std::string wrong : {R"(,"bus":7})", R"(,"bus":"a","bus":"b"})", R"(,"bus":})"}) {
    EXPECT_FALSE(parse_json_line(json_lines[0] + wrong, {0, 1})) << wrong;
  }
}

TEST(Origin, NamesAreThoseOfALogAndEachIsAnother) {
  const std::vector<std::string> urls{
      "can0",           "local:robot?bitrate=500000",       "local:can0",
      "socketcan:can0", "serial:/dev/serial/by-id/usb-one", "serial:/dev/serial/by-id/usb-two"};
  const auto origins = origins_of(urls);
  std::vector<std::string> names;
  names.reserve(origins.size());
  for (const Origin& origin : origins) {
    names.push_back(fmt::format("{} {}", origin.bus, origin.log_name));
  }
  EXPECT_EQ(names, (std::vector<std::string>{"can0 can0", "local:robot robot", "local:can0 can0~2",
                                             "socketcan:can0 can0~3",
                                             "serial:/dev/serial/by-id/usb-one /dev/serial/by-",
                                             "serial:/dev/serial/by-id/usb-two /dev/serial/b~2"}));
  EXPECT_EQ(width_of(origins), 15U);
}

TEST(RecordFormat, JsonOfAMessageIsReadBackAsTheSameMessage) {
  Buffer out;
  json_format(false)->frame(out, from_robot, received(0x0400400A, FrameKind::extended));
  const auto json = parse_json({out.data(), out.size() - 1});
  ASSERT_TRUE(json.ok()) << json.error().message;
  EXPECT_EQ(json->message.header,
            (Header{Priority::urgent, MessageClass::system, {0, 2}, {0, 10}}));
}

TEST(RecordFormat, JsonOfARemoteRequestHasALengthAndNoData) {
  Buffer out;
  json_format(false)->frame(out, from_robot, received(0x123, FrameKind::standard_remote));
  EXPECT_EQ(std::string(out.data(), out.size()),
            R"({"type":"CAN","kind":"standard-remote","id":291,"length":3,"data":[],)"
            R"("timestamp":1436509052.249713})"
            "\n");
}

}  // namespace
}  // namespace roio::cli
