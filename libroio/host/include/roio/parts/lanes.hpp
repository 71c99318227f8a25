#ifndef ROIO_PARTS_LANES_HPP
#define ROIO_PARTS_LANES_HPP

#include <cstddef>
#include <roio/frame.hpp>
#include <roio/header.hpp>

namespace roio {

/// Frames keep their order within a lane; those in the urgent lane pass the others.
inline constexpr std::size_t lane_count = 2;
inline constexpr std::size_t urgent_lane = 0;
inline constexpr std::size_t normal_lane = 1;

/// As the driver has it, for which a remote frame is as urgent as its identifier says.
inline std::size_t lane_in_driver(const Frame& frame) noexcept {
  return is_extended(frame.kind) && unpack_id(frame.id).priority == Priority::urgent ? urgent_lane
                                                                                     : normal_lane;
}

}  // namespace roio

#endif
