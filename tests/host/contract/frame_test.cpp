// What goes in comes out: every kind of frame, to everybody else, with its time.
#include <array>
#include <roio/error.hpp>
#include <system_error>

#include "contract.hpp"

namespace roio::test {
namespace {

ROIO_CONTRACT(Frames);

TEST_P(Frames, EveryKindAndLengthArrivesUnchanged) {
  const auto sender = join();
  const auto receiver = join();
  std::vector<Frame> frames;
  for (const FrameKind kind : {FrameKind::standard, FrameKind::standard_remote, FrameKind::extended,
                               FrameKind::extended_remote}) {
    for (std::uint8_t length = 0; length <= max_data_length; ++length) {
      const bool remote = is_remote(kind);
      frames.push_back(
          remote
              ? Frame{max_id(kind), kind, length, {}}
              : Frame{
                    max_id(kind), kind, length, {0x00, 0xFF, 0x0A, 0x80, 0x01, 0x7F, 0x0D, 0xAA}});
    }
    frames.push_back({0, kind, 0, {}});
  }
  // Of descending priority, so that arbitration does not change their order.
  for (const Frame& frame : frames) {
    ASSERT_EQ(sender->send(frame, guard), Result::ok);
    EXPECT_EQ(frames_of(receive_exactly(*receiver, 1)), std::vector{frame});
  }
  expect_silence(*receiver);
}

TEST_P(Frames, ReachEverybodyButTheSender) {
  const auto sender = join();
  const auto one = join();
  const auto other = join();
  const Frame frame = numbered(7);
  ASSERT_EQ(sender->send(frame, guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*one, 1)), std::vector{frame});
  EXPECT_EQ(frames_of(receive_exactly(*other, 1)), std::vector{frame});
  expect_silence(*sender);
  EXPECT_EQ(sender->statistics().received, 0U);
}

TEST_P(Frames, GoBothWays) {
  const auto a = join();
  const auto b = join();
  ASSERT_EQ(a->send(numbered(1), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*b, 1)), std::vector{numbered(1)});
  ASSERT_EQ(b->send(numbered(2), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*a, 1)), std::vector{numbered(2)});
}

TEST_P(Frames, SentBeforeAnotherJoinedAreNotForIt) {
  const auto sender = join();
  const auto witness = join();
  ASSERT_EQ(sender->send(numbered(1), guard), Result::ok);
  receive_exactly(*witness, 1);
  const auto late = join();
  ASSERT_EQ(sender->send(numbered(2), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*late, 1)), std::vector{numbered(2)});
}

struct BadFrame {
  const char* why;
  Frame frame;
};

constexpr BadFrame bad_frames[] = {
    {"standard identifier of 12 bits", {0x800, FrameKind::standard, 0, {}}},
    {"standard remote identifier of 12 bits", {0x800, FrameKind::standard_remote, 0, {}}},
    {"extended identifier of 30 bits", {0x20000000, FrameKind::extended, 0, {}}},
    {"extended remote identifier of 30 bits", {0x20000000, FrameKind::extended_remote, 0, {}}},
    {"nine bytes", {0x123, FrameKind::standard, 9, {}}},
    {"an error report", {0x4, FrameKind::error, 8, {}}},
    {"no kind of frame", {0x123, static_cast<FrameKind>(7), 0, {}}},
};

TEST_P(Frames, ThatNoBusCarriesThrowAndSendNothing) {
  const auto sender = join();
  const auto receiver = join();
  for (const BadFrame& row : bad_frames) {
    SCOPED_TRACE(row.why);
    const std::array<Frame, 3> batch{numbered(1), row.frame, numbered(2)};
    try {
      static_cast<void>(sender->send(batch, guard));
      ADD_FAILURE() << "nothing thrown";
    } catch (const std::system_error& error) {
      EXPECT_EQ(error.code(), make_error_code(Errc::bad_frame)) << error.what();
      EXPECT_NE(std::string(error.what()).find('1'), std::string::npos)
          << "frame 1 is to be named: " << error.what();
    }
  }
  EXPECT_EQ(sender->statistics().sent, 0U);
  ASSERT_EQ(sender->send(numbered(3), guard), Result::ok);
  EXPECT_EQ(frames_of(receive_exactly(*receiver, 1)), std::vector{numbered(3)});
}

TEST_P(Frames, AnEmptyListIsSentAtOnce) {
  const auto bus = join();
  const Transfer transfer = bus->send(std::span<const Frame>(), no_wait);
  EXPECT_EQ(transfer.result, Result::ok);
  EXPECT_EQ(transfer.count, 0U);
}

TEST_P(Frames, CarryTimesThatAreTrueAndDoNotGoBack) {
  constexpr std::chrono::seconds tolerance{5};  // clocks of kernel, hub and test are read apart
  constexpr std::uint32_t count = 100;
  const auto sender = join();
  const auto receiver = join();
  const auto before = std::chrono::system_clock::now();
  for (std::uint32_t i = 0; i < count; ++i) {
    ASSERT_EQ(sender->send(numbered(i), guard), Result::ok);
  }
  const std::vector<Received> received = receive_exactly(*receiver, count);
  const auto after = std::chrono::system_clock::now();
  Timestamp last = before - tolerance;
  for (const Received& one : received) {
    EXPECT_GE(one.time, last);
    last = one.time;
  }
  EXPECT_LE(last, after + tolerance);
}

TEST_P(Frames, NameIsWhatOpenWasGiven) {
  EXPECT_EQ(join()->name(), url().substr(0, url().find('?')));
}

}  // namespace
}  // namespace roio::test
