/// A bus that is never idle, every message on it for the board.
#ifndef ROIO_TESTS_FIRMWARE_LOAD_SATURATION_HPP
#define ROIO_TESTS_FIRMWARE_LOAD_SATURATION_HPP

#include <cstdint>
#include <roio/sim/time.hpp>
#include <string>

namespace roio::load {

struct SaturationCase {
  std::string image;  ///< Made from Saturated.
  std::uint32_t bitrate_bps;
  std::uint32_t osc_hz;
  int length;  ///< Of the data: 0..8.
};

struct SaturationReport {
  double bus_load = 0;         ///< 0..1, while messages were sent.
  std::uint64_t sent = 0;      ///< By the PC, and acknowledged.
  double frame_us = 0;         ///< On the bus, with the intermission, on average.
  std::uint64_t accepted = 0;  ///< By the chip.
  std::uint64_t overflowed = 0;
  std::uint64_t received = 0;          ///< By the sketch.
  std::uint64_t disordered = 0;        ///< Times that a message was not the next.
  std::uint64_t wrong = 0;             ///< Bytes of data that were not as sent.
  std::uint64_t counted_received = 0;  ///< As the driver counts them; modulo 65536.
  std::uint64_t counted_overflows = 0;
  std::uint64_t chip_losses = 0;
  std::uint64_t line_losses = 0;
  double left_over = 0;  ///< Of all the processor's time: work done by the sketch, 0..1.
};

/// @param span how long messages are sent.
SaturationReport saturate(const SaturationCase& load, sim::SimTime span);
/// The share that an idle bus leaves to the same image.
double left_over_when_idle(const SaturationCase& load, sim::SimTime span);

}  // namespace roio::load

#endif
