#ifndef ROIO_LOCAL_READERS_HPP
#define ROIO_LOCAL_READERS_HPP

#include <array>
#include <chrono>
#include <cstdint>
#include <roio/parts/fd.hpp>
#include <vector>

#include "local/log.hpp"
#include "local/slot_filters.hpp"

namespace roio::local {

inline constexpr std::uint64_t max_lag = 16384;  ///< Behind which the bus waits for a reader.
/// How long the bus waits for a reader that has stopped reading.
inline constexpr std::chrono::milliseconds patience{100};

/// The hub's care for those who read the log: wakes them, waits for those who lag, and takes away
/// from those whom the log runs over. It knows them by their slots, so also those who are still to
/// come over from the hub before.
class Readers {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit Readers(Memory& memory) : memory_(memory) {}

  /// A client has that slot from now on, or had it under the hub before.
  void add(std::size_t slot);
  void remove(std::size_t slot);
  /// How it is woken; none: it is not connected. It must outlive that.
  void set_wake(std::size_t slot, EventFlag* wake) { states_.at(slot).wake = wake; }

  static bool listens(const Slot& slot) noexcept {
    return slot.filter_count.load(std::memory_order_seq_cst) > 0;
  }
  /// How many listen.
  [[nodiscard]] std::size_t listeners() const;

  /// Nobody reads frames up to this number any more: their places are needed.
  void take_away(std::uint64_t number);

  /// Wakes who sleeps and wants one of the frames that the head has come to, and moves on who
  /// sleeps and wants none.
  void wake_for_news();
  void wake(std::size_t slot);
  /// If it has asked to be: `done` has moved.
  void wake_for_done(std::size_t slot);

  /// Whether the bus should wait: some reader lags, and has read lately. Asks those to tell when
  /// they have read on.
  bool hold_bus(TimePoint now);

 private:
  /// Something that should move on, and when it last did by as much as counts as moving.
  struct Progress {
    std::uint64_t value = 0;
    TimePoint since{};
    bool lagging = false;

    /// @return whether it is to be waited for.
    bool wait_for(bool lags, std::uint64_t now_value, TimePoint now);
  };
  struct State {
    SlotFilters filters;
    EventFlag* wake = nullptr;
    Progress program;  // takes what its library has read
    Progress library;  // reads the log
  };

  [[nodiscard]] std::uint64_t head() const {
    return memory_.header.head.load(std::memory_order_relaxed);
  }
  /// The first that is kept. No reader of ours is further behind.
  [[nodiscard]] std::uint64_t oldest() const {
    return head() >= log_size ? head() - log_size + 1 : 1;
  }
  std::uint64_t take_away_from(std::size_t index, std::uint64_t number);
  bool lags(std::size_t index, TimePoint now);
  void wake_if_wanted(std::size_t index);

  Memory& memory_;
  std::vector<std::size_t> used_;  // slots
  std::array<State, max_clients> states_;
  std::uint64_t unread_ = 0;  // no listener has a frame before this one to read
};

}  // namespace roio::local

#endif
