#ifndef ROIO_LOCAL_MEMORY_HPP
#define ROIO_LOCAL_MEMORY_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <roio/parts/fd.hpp>
#include <roio/parts/lanes.hpp>
#include <string>

#include "local/protocol.hpp"

/// What a local bus remembers, whoever carries it: its lock file, mapped by the hub and by every
/// client. A hub that ends, however it ends, leaves behind what was carried last, how far each
/// reader has come, and who is on the bus; the next one goes on from there.
///
/// The hub alone writes the header and the log. A slot is its client's and the hub's: who writes
/// which field stands there. Nothing here is trusted beyond that: a number out of range is taken
/// for the nearest in range, and harms nobody but the client whose slot it is in.
namespace roio::local {

inline constexpr std::size_t max_clients = 256;
inline constexpr std::uint64_t log_size = 65536;  ///< Frames that the bus keeps for all.
inline constexpr std::uint64_t queue_limit =
    65536;  ///< Frames that a client keeps for its program.

/// One frame as it was carried. Words, because a reader may look while the hub writes the next one
/// in its place: what it then read is thrown away (see LogReader).
using LogEntry = std::array<std::atomic<std::uint64_t>, 5>;

/// One client. All zero: free.
struct alignas(4096) Slot {
  // The hub's.
  std::atomic<std::uint64_t> client;  ///< Its random number; 0: free.
  std::array<std::atomic<std::uint64_t>, lane_count>
      done;                            ///< Its frames up to here are in the log.
  std::atomic<std::uint64_t> unheard;  ///< Its frames that were carried while nobody else listened.
  std::atomic<std::uint64_t> dropped;  ///< See Position.

  // Both change it, by exchange.
  alignas(64) std::atomic<std::uint64_t> position;  ///< A Position, packed.
  std::atomic<std::uint32_t> sleeping;              ///< 1: wake me for the next frame that I want.
  std::atomic<std::uint32_t> awaits_done;           ///< 1: wake me when `done` has moved.
  std::atomic<std::uint32_t> bus_waits;  ///< 1: senders wait for this reader; it shall say when it
                                         ///< has read.

  // The client's.
  alignas(64) std::atomic<std::uint64_t> queued;  ///< Frames that its program has not taken yet.
  std::atomic<std::uint64_t> consumed;            ///< And such as it has, since it was welcomed.
  std::atomic<std::uint32_t> filter_version;      ///< Odd while the filters change.
  std::atomic<std::uint32_t> filter_count;        ///< 0: receives nothing.
  std::array<std::atomic<std::uint64_t>, max_filters> filters;  ///< Identifier, mask above it.
};

// The head has a line of the processor's caches for itself:
// NOLINTNEXTLINE(*-optin.performance.Padding)
struct Header {
  std::atomic<std::uint64_t> magic;        ///< Says that all this is set up, and laid out as here.
  std::atomic<std::uint64_t> identity;     ///< Random: of the bus since somebody was on it.
  std::atomic<std::uint64_t> hubs;         ///< How many have carried it.
  std::atomic<std::uint64_t> host;         ///< Client that is there to carry it; 0: none.
  std::atomic<std::int32_t> process;       ///< Of the hub.
  std::atomic<std::uint32_t> bitrate_bps;  ///< 0: none.
  alignas(64) std::atomic<std::uint64_t> head;  ///< Number of the frame carried last; from 1.
};

struct Memory {
  alignas(4096) Header header;
  std::array<Slot, max_clients> slots;
  alignas(4096) std::array<LogEntry, log_size> log;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "shared between processes");
static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "shared between processes");

/// A part of a file in memory, shared with all who have mapped it.
class Mapping {
 public:
  Mapping() = default;
  /// @param offset of the part; needs not be a page's. @throws std::system_error.
  Mapping(int fd, std::size_t offset, std::size_t size, bool writable);
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping();

  [[nodiscard]] void* at() const { return at_; }

 private:
  void* start_ = nullptr;
  std::size_t length_ = 0;
  void* at_ = nullptr;
};

/// The hub's view: all of it, to write.
class HubMemory {
 public:
  /// Gives the file its size where it is empty; what is in it stays. Nobody else may do so at the
  /// time: the caller holds the seat.
  /// @throws std::system_error: no room in the file system.
  explicit HubMemory(int lock_fd);

  [[nodiscard]] Memory& operator*() const { return *static_cast<Memory*>(mapping_.at()); }
  [[nodiscard]] Memory* operator->() const { return &**this; }
  /// Whether a hub of this version has set it up.
  [[nodiscard]] bool is_set_up() const;
  /// Forgets everybody and everything: a new bus.
  void set_up(std::uint32_t bitrate_bps);

 private:
  Mapping mapping_;
};

/// A client's view: all to read, its own slot to write.
class ClientMemory {
 public:
  /// @param slot below max_clients. @throws std::system_error.
  ClientMemory(int lock_fd, std::size_t slot);

  [[nodiscard]] const Memory& operator*() const { return *static_cast<Memory*>(all_.at()); }
  [[nodiscard]] const Memory* operator->() const { return &**this; }
  [[nodiscard]] Slot& slot() const { return *static_cast<Slot*>(own_.at()); }

 private:
  Mapping all_;
  Mapping own_;
};

/// Whether any client of the memory is alive. @param lock_fd of its file, where they show it.
bool has_living_clients(const Memory& memory, int lock_fd) noexcept;
/// The client that is there to carry the bus, while it is alive; 0: none.
std::uint64_t living_host(const Memory& memory, int lock_fd) noexcept;

/// Whether the file is of another version: its clients may have it mapped, so it must not change.
bool is_foreign_memory(int lock_fd);

/// What can be known of a bus by its lock file alone.
class MemoryView {
 public:
  /// Nothing, when there is no such file or no hub of this version has set it up.
  explicit MemoryView(const std::string& lock_path);
  explicit MemoryView(int lock_fd);

  explicit operator bool() const { return is_set_up_; }
  [[nodiscard]] const Memory& operator*() const { return *static_cast<Memory*>(mapping_.at()); }
  [[nodiscard]] const Memory* operator->() const { return &**this; }

  /// See has_living_clients(), living_host().
  [[nodiscard]] bool has_clients() const {
    return is_set_up_ && has_living_clients(**this, lock_fd_);
  }
  [[nodiscard]] std::uint64_t host() const {
    return is_set_up_ ? living_host(**this, lock_fd_) : 0;
  }

 private:
  void look(int lock_fd);

  UniqueFd file_;
  Mapping mapping_;
  int lock_fd_ = -1;
  bool is_set_up_ = false;
};

}  // namespace roio::local

#endif
