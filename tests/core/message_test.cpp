#include <gtest/gtest.h>

#include <algorithm>
#include <roio/message.hpp>

namespace roio {
namespace {

constexpr Header arm{Priority::normal, MessageClass::message, {0, 2}, {0, 10}};

bool operator==(const Message& a, const Message& b) {
  return a.header == b.header && a.length == b.length &&
         std::equal(std::begin(a.data), std::end(a.data), b.data);
}
bool operator==(const Frame& a, const Frame& b) {
  return a.id == b.id && a.kind == b.kind && a.length == b.length &&
         std::equal(std::begin(a.data), std::end(a.data), b.data);
}

constexpr Frame untouched_frame{7, FrameKind::standard, 2, {9, 9, 9, 9, 9, 9, 9, 9}};
constexpr Message untouched_message{
    {Priority::urgent, MessageClass::stream, {9, 9}, {9, 9}}, 9, {9, 9, 9, 9, 9, 9, 9, 9}};

TEST(ToFrame, ClearsTheDataPastTheLength) {
  Frame frame = untouched_frame;
  ASSERT_EQ(to_frame(Message{arm, 3, {0x5A, 0x2D, 0x00, 4, 5, 6, 7, 8}}, frame), Status::ok);
  EXPECT_TRUE(frame == (Frame{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D}}));
}

TEST(ToFrame, TakesEveryLengthAndRefusesNine) {
  for (std::uint8_t length = 0; length <= 8; ++length) {
    Frame frame{};
    ASSERT_EQ(to_frame(Message{arm, length, {}}, frame), Status::ok);
    EXPECT_EQ(frame.length, length);
  }
  for (const int length : {9, 15, 255}) {
    Frame frame = untouched_frame;
    EXPECT_EQ(to_frame(Message{arm, static_cast<std::uint8_t>(length), {}}, frame),
              Status::bad_argument);
    EXPECT_TRUE(frame == untouched_frame);
  }
}

TEST(ToFrame, RefusesWhatMayNotBeSent) {
  const struct {
    const char* why;
    Header header;
  } cases[] = {
      {"reserved class", {Priority::normal, MessageClass::reserved, {0, 2}, {0, 10}}},
      {"class past the field", {Priority::normal, static_cast<MessageClass>(4), {0, 2}, {0, 10}}},
      {"priority past the field",
       {static_cast<Priority>(2), MessageClass::message, {0, 2}, {0, 1}}},
      {"destination subnet 32", {Priority::normal, MessageClass::message, {32, 2}, {0, 10}}},
      {"source subnet 32", {Priority::normal, MessageClass::message, {0, 2}, {32, 10}}},
      {"source is a broadcast", {Priority::normal, MessageClass::message, {0, 2}, {0, 255}}},
  };
  for (const auto& row : cases) {
    SCOPED_TRACE(row.why);
    Frame frame = untouched_frame;
    EXPECT_EQ(to_frame(Message{row.header, 1, {1}}, frame), Status::bad_argument);
    EXPECT_TRUE(frame == untouched_frame);
  }
}

struct ReceiveCase {
  const char* why;
  Frame frame;
  Status status;
  Message message;  ///< What is expected when status is ok.
};

TEST(ToMessage, TellsEveryKindOfFrameApart) {
  const std::uint32_t good = 0x1000400A;
  const ReceiveCase cases[] = {
      {"a message",
       {good, FrameKind::extended, 3, {0x5A, 0x2D, 0x00, 4, 5, 6, 7, 8}},
       Status::ok,
       {arm, 3, {0x5A, 0x2D}}},
      {"no data is a message still", {good, FrameKind::extended, 0, {1}}, Status::ok, {arm, 0, {}}},
      {"eight bytes",
       {good, FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
       Status::ok,
       {arm, 8, {1, 2, 3, 4, 5, 6, 7, 8}}},
      {"DLC 9 is eight bytes",
       {good, FrameKind::extended, 9, {1, 2, 3, 4, 5, 6, 7, 8}},
       Status::ok,
       {arm, 8, {1, 2, 3, 4, 5, 6, 7, 8}}},
      {"DLC 15 is eight bytes",
       {good, FrameKind::extended, 15, {1, 2, 3, 4, 5, 6, 7, 8}},
       Status::ok,
       {arm, 8, {1, 2, 3, 4, 5, 6, 7, 8}}},
      {"a broadcast",
       {0x101FE00A, FrameKind::extended, 0, {}},
       Status::ok,
       {{Priority::normal, MessageClass::message, {0, 255}, {0, 10}}, 0, {}}},
      {"standard", {0x2A, FrameKind::standard, 1, {1}}, Status::not_roio, {}},
      {"standard remote", {0x2A, FrameKind::standard_remote, 1, {}}, Status::not_roio, {}},
      {"extended remote", {good, FrameKind::extended_remote, 0, {}}, Status::not_roio, {}},
      {"error report", {good, FrameKind::error, 8, {}}, Status::not_roio, {}},
      {"reserved class", {0x1C00400A, FrameKind::extended, 1, {1}}, Status::unknown_class, {}},
      {"broadcast address as source",
       {0x100040FF, FrameKind::extended, 1, {1}},
       Status::bad_argument,
       {}},
      {"reserved class counts before the source",
       {0x1C0040FF, FrameKind::extended, 1, {1}},
       Status::unknown_class,
       {}},
      {"kind counts before everything",
       {0x1C0040FF, FrameKind::extended_remote, 1, {1}},
       Status::not_roio,
       {}},
  };
  for (const ReceiveCase& row : cases) {
    SCOPED_TRACE(row.why);
    Message message = untouched_message;
    EXPECT_EQ(to_message(row.frame, message), row.status);
    EXPECT_TRUE(message == (row.status == Status::ok ? row.message : untouched_message));
  }
}

}  // namespace
}  // namespace roio
