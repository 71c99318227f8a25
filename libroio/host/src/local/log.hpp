#ifndef ROIO_LOCAL_LOG_HPP
#define ROIO_LOCAL_LOG_HPP

#include <cstddef>
#include <cstdint>

#include "local/memory.hpp"

/// The log of a local bus: the frames carried last, in their order, in memory that the hub writes
/// and all readers read, each at its own pace. Frames are numbered from 1.
namespace roio::local {

struct Carried {
  std::uint64_t sender;
  std::uint64_t sequence;
  std::size_t lane;
  std::int64_t time_ns;  ///< Since 1970, when its last bit had passed.
  WireFrame frame;
};

/// By the hub, before the head says that the frame is there.
void store(LogEntry& entry, const Carried& carried) noexcept;
/// What is there; nonsense, when the hub is writing the next one in its place.
Carried load(const LogEntry& entry) noexcept;

inline LogEntry& entry_of(Memory& memory, std::uint64_t number) noexcept {
  return memory.log[number % log_size];
}
inline const LogEntry& entry_of(const Memory& memory, std::uint64_t number) noexcept {
  return memory.log[number % log_size];
}

/// Calls visit(const Carried&) for what is in the log, but for the oldest that it has room for: in
/// its place a hub may have been writing the next one when it was killed.
template <typename Visit>
void for_each_whole(const Memory& memory, const Visit& visit) {
  const std::uint64_t head = memory.header.head.load(std::memory_order_acquire);
  for (std::uint64_t i = head >= log_size ? head - log_size + 2 : 1; i <= head; ++i) {
    visit(load(entry_of(memory, i)));
  }
}

/// Up to where a sender's frames are in the log, in each lane, as far as for_each_whole() sees
/// them; 0: none is.
std::array<std::uint64_t, lane_count> last_carried(const Memory& memory, std::uint64_t sender);

/// Where a reader is. When the log is about to run over what it has not read, the hub moves it on
/// and counts what it wanted of that: both in one exchange, so that a frame is either read or
/// counted, never both and never neither, whoever dies when. The reader moves itself on by an
/// exchange, too, after it has copied what it read: if that fails, the copy is worth nothing.
struct Position {
  std::uint64_t next;     ///< Number of the frame to be read next; 48 bits.
  std::uint16_t dropped;  ///< The low bits of how many wanted frames have been taken away.
};
std::uint64_t pack(const Position& position) noexcept;
Position unpack(std::uint64_t word) noexcept;

/// All bits of Position::dropped. @param near what Slot::dropped says: it is written a moment later
/// than the position, so it is off by less than half of what the low bits count.
std::uint64_t exact_dropped(std::uint16_t dropped, std::uint64_t near) noexcept;

}  // namespace roio::local

#endif
