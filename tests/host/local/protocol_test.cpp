// The records between hub and client: layout, and everything that is no record.
#include "local/protocol.hpp"

#include <gtest/gtest.h>

namespace roio::local {
namespace {

constexpr Frame some_frame{0x1004A00A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};

Buffer bytes_of(const OfferedFrame& offered) {
  Buffer bytes;
  append_record(bytes, offered);
  return bytes;
}

TEST(LocalRecords, FrameComesBackAsItWas) {
  const Buffer bytes = bytes_of({7, normal_lane, 0, to_wire(some_frame)});
  std::span<const std::uint8_t> rest = bytes;
  Record record{};
  ASSERT_EQ(take_record(rest, record), Split::record);
  EXPECT_TRUE(rest.empty());
  const auto offered = record.as<OfferedFrame>();
  EXPECT_EQ(offered.sequence, 7U);
  const auto frame = from_wire(offered.frame);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, some_frame.id);
  EXPECT_EQ(frame->kind, some_frame.kind);
  EXPECT_EQ(frame->length, some_frame.length);
  EXPECT_TRUE(std::equal(std::begin(frame->data), std::end(frame->data), some_frame.data));
}

TEST(LocalRecords, EveryBeginningOfARecordIsIncompleteAndTakesNothing) {
  const Buffer bytes = bytes_of({7, normal_lane, 0, to_wire(some_frame)});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    std::span<const std::uint8_t> rest = std::span(bytes).first(size);
    Record record{};
    EXPECT_EQ(take_record(rest, record), Split::incomplete) << size;
    EXPECT_EQ(rest.size(), size);
  }
}

struct MalformedHead {
  const char* why;
  RecordHead head;
};

TEST(LocalRecords, MalformedHeadsAreRefusedBeforeTheirBodyIsWaitedFor) {
  const MalformedHead rows[] = {
      {"no such type", {0, static_cast<RecordType>(0), 0}},
      {"one past the last type", {sizeof(GoOn), static_cast<RecordType>(10), 0}},
      {"a type of an older version", {0, static_cast<RecordType>(2), 0}},
      {"one byte short", {sizeof(OfferedFrame) - 1, RecordType::frame, 0}},
      {"one byte long", {sizeof(OfferedFrame) + 1, RecordType::frame, 0}},
      {"the spare byte set", {sizeof(OfferedFrame), RecordType::frame, 1}},
  };
  for (const MalformedHead& row : rows) {
    Buffer bytes(sizeof(RecordHead));
    std::memcpy(bytes.data(), &row.head, sizeof(RecordHead));
    std::span<const std::uint8_t> rest = bytes;
    Record record{};
    EXPECT_EQ(take_record(rest, record), Split::malformed) << row.why;
  }
}

TEST(LocalRecords, FramesThatNoBusCarriesAreRefused) {
  WireFrame wire = to_wire(some_frame);
  EXPECT_TRUE(from_wire(wire));
  wire.length = 9;
  EXPECT_FALSE(from_wire(wire)) << "9 bytes";
  wire = to_wire(some_frame);
  wire.tagged_id = 0x800;
  EXPECT_FALSE(from_wire(wire)) << "standard, 12 bits";
  wire.tagged_id = 0x7FF;
  EXPECT_TRUE(from_wire(wire)) << "standard, 11 bits";
  wire.tagged_id = 0x20000004;
  EXPECT_FALSE(from_wire(wire)) << "an error report";
  wire.tagged_id = 0xA0000004;
  EXPECT_FALSE(from_wire(wire)) << "error and extended at once";
}

TEST(LocalRecords, OnlyUrgentRoioFramesTakeTheUrgentLane) {
  EXPECT_EQ(lane_of({0x00000000, FrameKind::extended, 0, {}}), urgent_lane);
  EXPECT_EQ(lane_of({0x0FFFFFFF, FrameKind::extended, 0, {}}), urgent_lane);
  EXPECT_EQ(lane_of({0x10000000, FrameKind::extended, 0, {}}), normal_lane);
  EXPECT_EQ(lane_of({0x000, FrameKind::standard, 0, {}}), normal_lane);
  EXPECT_EQ(lane_of({0x000, FrameKind::extended_remote, 0, {}}), normal_lane);
}

}  // namespace
}  // namespace roio::local
