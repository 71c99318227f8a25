#include "local/log.hpp"

#include <cstring>

namespace roio::local {
namespace {

// word 0  sender
// word 1  sequence, above the lane
// word 2  time
// word 3  length, above the tagged identifier
// word 4  data
constexpr unsigned lane_bits = 1;
constexpr unsigned id_bits = 32;
constexpr unsigned dropped_bits = 16;

}  // namespace

void store(LogEntry& entry, const Carried& carried) noexcept {
  std::uint64_t data = 0;
  static_assert(sizeof data == sizeof carried.frame.data);
  std::memcpy(&data, carried.frame.data.data(), sizeof data);
  constexpr auto relaxed = std::memory_order_relaxed;  // the head publishes all of it
  entry[0].store(carried.sender, relaxed);
  entry[1].store(carried.sequence << lane_bits | carried.lane, relaxed);
  entry[2].store(static_cast<std::uint64_t>(carried.time_ns), relaxed);
  entry[3].store(std::uint64_t{carried.frame.length} << id_bits | carried.frame.tagged_id, relaxed);
  entry[4].store(data, relaxed);
}

Carried load(const LogEntry& entry) noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  const std::uint64_t order = entry[1].load(relaxed);
  const std::uint64_t head = entry[3].load(relaxed);
  const std::uint64_t data = entry[4].load(relaxed);
  Carried carried{
      entry[0].load(relaxed),
      order >> lane_bits,
      static_cast<std::size_t>(order & ((1U << lane_bits) - 1)),
      static_cast<std::int64_t>(entry[2].load(relaxed)),
      {static_cast<std::uint32_t>(head), static_cast<std::uint8_t>(head >> id_bits), {}, {}}};
  std::memcpy(carried.frame.data.data(), &data, sizeof data);
  return carried;
}

std::array<std::uint64_t, lane_count> last_carried(const Memory& memory, std::uint64_t sender) {
  std::array<std::uint64_t, lane_count> last{};
  for_each_whole(memory, [&](const Carried& carried) {
    if (carried.sender == sender) {
      last.at(carried.lane) = carried.sequence;
    }
  });
  return last;
}

std::uint64_t pack(const Position& position) noexcept {
  return position.next << dropped_bits | position.dropped;
}

Position unpack(std::uint64_t word) noexcept {
  return {word >> dropped_bits, static_cast<std::uint16_t>(word)};
}

std::uint64_t exact_dropped(std::uint16_t dropped, std::uint64_t near) noexcept {
  const auto off = static_cast<std::int16_t>(dropped - static_cast<std::uint16_t>(near));
  return near + static_cast<std::uint64_t>(std::int64_t{off});
}

}  // namespace roio::local
