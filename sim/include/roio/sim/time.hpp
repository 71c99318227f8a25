/// Simulated time: picoseconds since the simulation began, so that the bit times of all rates and
/// the clocks of all oscillators in use are whole numbers, or as good as.
#ifndef ROIO_SIM_TIME_HPP
#define ROIO_SIM_TIME_HPP

#include <chrono>
#include <cstdint>
#include <ratio>

namespace roio::sim {

/// A moment or a span; 64 bits hold 106 days.
using SimTime = std::chrono::duration<std::int64_t, std::pico>;

/// How long `count` cycles of a clock take, to the picosecond.
/// @param hz above 0; count * 10^12 must fit in 63 bits (9 million cycles).
constexpr SimTime cycles(std::int64_t count, std::uint32_t hz) {
  return SimTime(count * std::int64_t{1'000'000'000'000} / hz);
}

}  // namespace roio::sim

#endif
