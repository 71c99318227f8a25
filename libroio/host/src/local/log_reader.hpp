#ifndef ROIO_LOCAL_LOG_READER_HPP
#define ROIO_LOCAL_LOG_READER_HPP

#include <cstddef>
#include <cstdint>
#include <span>

#include "local/log.hpp"

namespace roio::local {

/// A client's reading of the log. One thread at a time.
class LogReader {
 public:
  /// Of a slot that is new.
  LogReader(const Memory& memory, Slot& slot) : memory_(memory), slot_(slot) {}

  struct Read {
    std::size_t count;   ///< Frames read, wanted or not; 0: there are none.
    std::uint64_t lost;  ///< Wanted ones that were taken away before the first of these.
  };
  /// The next ones. @param frames room for them; not empty.
  Read read(std::span<Carried> frames) noexcept;

  /// Begins to listen: the filters have just been published, and were none before. What was
  /// carried up to now is left out, and nothing of it was lost.
  void begin() noexcept;

  /// From now on this reader is woken for the next frame. @return false: there is one already, and
  /// it is not.
  bool sleep() noexcept;
  void stay_awake() noexcept { slot_.sleeping.store(0, std::memory_order_relaxed); }

  /// All wanted frames that have been taken away, told or not.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return all_dropped() - never_due_; }

 private:
  [[nodiscard]] std::uint64_t head() const noexcept {
    return memory_.header.head.load(std::memory_order_seq_cst);
  }

  [[nodiscard]] std::uint64_t all_dropped() const noexcept;

  const Memory& memory_;
  Slot& slot_;
  std::uint64_t told_ = 0;       // of those that were taken away
  std::uint64_t never_due_ = 0;  // of those, too: taken before begin() had come to its end
};

}  // namespace roio::local

#endif
