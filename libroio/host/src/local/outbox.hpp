#ifndef ROIO_LOCAL_OUTBOX_HPP
#define ROIO_LOCAL_OUTBOX_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <roio/frame.hpp>
#include <roio/parts/lanes.hpp>

#include "local/memory.hpp"
#include "local/protocol.hpp"

namespace roio::local {

/// A client's frames that are on their way: kept until they are in the bus's log, so that they can
/// be offered to the next hub when this one goes. The caller holds the bus's lock.
class Outbox {
 public:
  /// @param in_order all in one lane, so that none passes another.
  explicit Outbox(bool in_order) : in_order_(in_order) {}

  /// A hub that has been offered nothing yet.
  void begin(std::uint32_t window) {
    window_ = window;
    offered_.fill(0);
  }

  /// Takes the frame and appends its record. @return false: its lane has as many on their way as
  /// may be.
  /// @throws std::bad_alloc: it is not taken.
  bool offer(const Frame& frame, Buffer& out);
  /// Appends records of what this hub has not been offered, as many as may be on their way.
  /// @return how many. @throws std::bad_alloc: no harm done; again.
  std::size_t offer_again(Buffer& out);
  /// Whether some are kept that this hub has not been offered.
  [[nodiscard]] bool has_more() const {
    return offered_[0] < kept_[0].size() || offered_[1] < kept_[1].size();
  }
  /// Forgets what the log has. @param slot the client's.
  void settle(const Slot& slot);
  /// The same, up to a sequence number in each lane.
  void settle(const std::array<std::uint64_t, lane_count>& done);

  /// On their way.
  [[nodiscard]] std::size_t size() const { return kept_[0].size() + kept_[1].size(); }
  /// How many have been forgotten, in all.
  [[nodiscard]] std::uint64_t settled() const { return settled_; }

 private:
  const bool in_order_;
  std::uint32_t window_ = 0;
  std::array<std::deque<OfferedFrame>, lane_count> kept_;
  std::array<std::size_t, lane_count> offered_{};  // of kept_, to this hub
  std::array<std::uint64_t, lane_count> sequence_{};
  std::uint64_t settled_ = 0;
};

}  // namespace roio::local

#endif
