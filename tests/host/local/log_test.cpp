// The log in shared memory: what a reader reads, what is taken away from it, and that a frame is
// one or the other, whoever is how slow.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "local/log_reader.hpp"
#include "memory_rig.hpp"

namespace roio::local {
namespace {

using test::MemoryRig;

constexpr std::array everything{SocketCanFilter{0, 0}};
constexpr std::array only_two{SocketCanFilter{2, 0x7FF}};

std::uint64_t number_of(const Carried& carried) {
  std::uint64_t number = 0;
  std::memcpy(&number, carried.frame.data.data(), sizeof number);
  return number;
}

TEST(Log, AnEntryComesBackAsItWas) {
  LogEntry entry{};
  const Carried carried{0xFEDCBA9876543210,
                        0x123456789ABCDEF,
                        urgent_lane,
                        -5,
                        {0x9004A00A, 3, {}, {1, 2, 3, 4, 5, 6, 7, 8}}};
  store(entry, carried);
  const Carried again = load(entry);
  EXPECT_EQ(again.sender, carried.sender);
  EXPECT_EQ(again.sequence, carried.sequence);
  EXPECT_EQ(again.lane, carried.lane);
  EXPECT_EQ(again.time_ns, carried.time_ns);
  EXPECT_EQ(again.frame.tagged_id, carried.frame.tagged_id);
  EXPECT_EQ(again.frame.length, carried.frame.length);
  EXPECT_EQ(again.frame.data, carried.frame.data);
}

TEST(Log, APositionComesBackAsItWas) {
  for (const Position position : {Position{1, 0}, Position{(UINT64_C(1) << 48) - 1, 0xFFFF}}) {
    const Position again = unpack(pack(position));
    EXPECT_EQ(again.next, position.next);
    EXPECT_EQ(again.dropped, position.dropped);
  }
}

TEST(Log, DroppedIsExactThoughItsUpperBitsAreWrittenLater) {
  EXPECT_EQ(exact_dropped(5, 3), 5U);
  EXPECT_EQ(exact_dropped(0, 0x1FFFF), 0x20000U) << "the low bits have gone around";
  EXPECT_EQ(exact_dropped(0xFFFF, 0x20000), 0x1FFFFU) << "the upper bits were read later";
  EXPECT_EQ(exact_dropped(0x7000, 0x10000), 0x17000U);
}

TEST(LogReader, ReadsInOrderWhatCameSinceItBegan) {
  MemoryRig memory;
  memory.carry(2);
  LogReader reader(*memory, memory.add_client(0, everything));
  std::array<Carried, 4> frames;
  EXPECT_EQ(reader.read(frames).count, 0U);
  memory.carry_many(6, 2);
  EXPECT_EQ(reader.read(frames).count, 4U);
  EXPECT_EQ(number_of(frames[0]), 2U);
  EXPECT_EQ(number_of(frames[3]), 5U);
  EXPECT_EQ(reader.read(frames).count, 2U);
  EXPECT_EQ(number_of(frames[1]), 7U);
}

TEST(LogReader, WhatTheLogRunsOverIsCountedWhereItWasWanted) {
  MemoryRig memory;
  LogReader reader(*memory, memory.add_client(0, only_two));
  memory.carry_many(10, 2);
  memory.carry_many(log_size - 10, 3);
  EXPECT_EQ(reader.dropped(), 0U) << "all of it is still there";
  memory.carry(3);
  EXPECT_EQ(reader.dropped(), 10U);
  std::array<Carried, 1> frames;
  const LogReader::Read read = reader.read(frames);
  EXPECT_EQ(read.count, 1U);
  EXPECT_EQ(read.lost, 10U) << "told with the first that is left";
  EXPECT_EQ(reader.read(frames).lost, 0U) << "once";
}

TEST(LogReader, WhoOnlySendsLosesNothing) {
  MemoryRig memory;
  LogReader reader(*memory, memory.add_client(0, {}));
  memory.carry_many(2 * log_size, 2);
  publish_filters(memory->slots[0], everything);
  memory.carry_many(log_size, 2);  // a hub that is quick: before begin()
  reader.begin();
  EXPECT_EQ(reader.dropped(), 0U);
  std::array<Carried, 4> frames;
  EXPECT_EQ(reader.read(frames).count, 0U);
  memory.carry(2);
  const LogReader::Read read = reader.read(frames);
  EXPECT_EQ(read.count, 1U);
  EXPECT_EQ(read.lost, 0U);
  EXPECT_EQ(number_of(frames[0]), 3 * log_size + 1);
}

TEST(LogReader, DoesNotSleepOverNews) {
  MemoryRig memory;
  LogReader reader(*memory, memory.add_client(0, everything));
  EXPECT_TRUE(reader.sleep());
  EXPECT_EQ(memory->slots[0].sleeping, 1U);
  memory.carry(2);
  EXPECT_FALSE(reader.sleep());
  EXPECT_EQ(memory->slots[0].sleeping, 0U);
}

// A writer that waits for nobody, and a reader that it laps again and again.
TEST(LogReader, EveryFrameIsReadOrCountedNeverBothWhileTheLogRunsOverIt) {
  MemoryRig memory;
  LogReader reader(*memory, memory.add_client(0, everything));
  constexpr std::uint64_t count = 20 * log_size;
  std::atomic<bool> over{false};
  std::jthread writer([&] {
    memory.carry_many(count, 2);
    over = true;
  });
  std::uint64_t received = 0;
  std::uint64_t lost = 0;
  std::uint64_t rounds = 0;
  std::uint64_t out_of_place = 0;
  std::array<Carried, 64> frames;
  for (;;) {
    const bool was_over = over;
    const LogReader::Read read = reader.read(frames);
    lost += read.lost;
    for (std::size_t i = 0; i < read.count; ++i) {
      out_of_place += number_of(frames.at(i)) == received + lost + i + 1 ? 0U : 1U;
    }
    received += read.count;
    if (read.count == 0 && was_over) {
      break;
    }
    // Now and then it waits until it is lapped.
    const std::uint64_t lap = received + lost + log_size + 1;
    while (++rounds % 500 == 0 && !over && memory->header.head < lap) {
      std::this_thread::yield();
      --rounds;
    }
  }
  writer.join();
  EXPECT_EQ(received + lost, count);
  EXPECT_EQ(out_of_place, 0U);
  EXPECT_EQ(reader.dropped(), lost);
  EXPECT_GT(lost, 0U) << "it has been lapped";
  EXPECT_GT(received, 0U);
}

}  // namespace
}  // namespace roio::local
