#ifndef ROIO_LOCAL_COUNTERS_HPP
#define ROIO_LOCAL_COUNTERS_HPP

#include <atomic>
#include <cstdint>
#include <roio/parts/fd.hpp>

namespace roio::local {

/// What a hub knows of one client's losses, and of the others on the bus, in memory that both see:
/// it outlives a hub that is killed, so the client can still tell what it lost with it. Written by
/// the hub only.
struct HubCounters {
  std::atomic<std::uint64_t> dropped;    ///< Due to the client and dropped, its queue being full.
  std::atomic<std::uint64_t> at_risk;    ///< Reported done to their senders, still only in the hub.
  std::atomic<std::uint64_t> unheard;    ///< The client's own, carried while nobody else listened.
  std::atomic<std::uint64_t> listeners;  ///< Other clients that have filters.
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "shared between processes");

/// A HubCounters in shared memory. The hub creates it and passes fd() on; the client maps that.
class CounterPage {
 public:
  /// Zeroed, of a size that nobody can change. @throws std::system_error.
  CounterPage();
  /// Maps another's page, to read. @throws std::system_error.
  explicit CounterPage(UniqueFd fd);
  CounterPage(CounterPage&& other) noexcept;
  CounterPage& operator=(CounterPage&& other) noexcept;
  CounterPage(const CounterPage&) = delete;
  CounterPage& operator=(const CounterPage&) = delete;
  ~CounterPage();

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  [[nodiscard]] HubCounters& counters() const noexcept { return *counters_; }

 private:
  UniqueFd fd_;
  HubCounters* counters_;
};

}  // namespace roio::local

#endif
