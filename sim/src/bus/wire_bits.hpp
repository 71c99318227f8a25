#ifndef ROIO_SIM_WIRE_BITS_HPP
#define ROIO_SIM_WIRE_BITS_HPP

#include <array>
#include <cstdint>
#include <roio/frame.hpp>

namespace roio::sim {

/// The bits of a frame as its transmitter puts them on the wire, stuff bits included: from
/// start-of-frame to the end of the CRC. The ten bits after that are the same in every frame.
struct WireBits {
  static constexpr std::size_t max_size = 150;  ///< 118 bits and at most one stuff bit in four.

  std::array<std::uint8_t, max_size> bits{};  ///< 0 dominant, 1 recessive.
  std::uint8_t size = 0;
  /// Index of the RTR bit, the last one in which arbitration may be lost.
  std::uint8_t arbitration_end = 0;
};

/// @param frame valid, not an error report; a length of 9..15 is sent as that DLC with 8 bytes.
WireBits wire_bits_of(const Frame& frame);

}  // namespace roio::sim

#endif
