#ifndef ROIO_PARTS_LANES_HPP
#define ROIO_PARTS_LANES_HPP

#include <cstddef>
#include <roio/frame.hpp>
#include <roio/header.hpp>

namespace roio {

/// The two lanes of a transmit queue, for backends that let urgent frames pass: frames keep their
/// order within a lane, and those in the urgent lane go before the others. Indices into an array of
/// lane_count queues.
inline constexpr std::size_t lane_count = 2;
inline constexpr std::size_t urgent_lane = 0;
inline constexpr std::size_t normal_lane = 1;

/// Which lane a frame belongs to, as the MCP2515 driver has it: urgent when bit 28 of an extended
/// identifier is 0. A remote frame is as urgent as its identifier says; a standard frame is not.
/// @param frame is_valid(). Pure.
inline std::size_t lane_in_driver(const Frame& frame) noexcept {
  return is_extended(frame.kind) && unpack_id(frame.id).priority == Priority::urgent ? urgent_lane
                                                                                     : normal_lane;
}

/// OpenOptions::in_order for such backends: when a frame may be put in its lane. One of the other
/// lane waits until all before it have gone: an urgent one would pass them, and a normal one may
/// find a transmit buffer of its own free while urgent ones still wait for theirs.
class LaneOrder {
 public:
  /// @param in_order false: always.
  explicit LaneOrder(bool in_order) : in_order_(in_order) {}

  /// @param all_gone whether nothing that was accepted is still on its way. The sender has to be
  ///        woken (see send_queued()) when that becomes so.
  [[nodiscard]] bool admits(std::size_t lane, bool all_gone) const noexcept {
    return !in_order_ || lane == last_ || all_gone;
  }
  void accepted(std::size_t lane) noexcept { last_ = lane; }

 private:
  bool in_order_;
  std::size_t last_ = normal_lane;  // of the frame accepted last
};

}  // namespace roio

#endif
