// Bit timing of the simulated MCP2515 (5).
#include <algorithm>
#include <roio/sim/mcp2515_chip.hpp>

#include "mcp2515/map.hpp"

namespace roio::sim {
namespace {

constexpr int information_processing_time = 2;  // quanta, the least that PS2 can be (5.1)

struct Segments {
  int propagation;
  int phase1;
  int phase2;
  int jump;
};

Segments segments_of(std::uint8_t cnf1, std::uint8_t cnf2, std::uint8_t cnf3) {
  const int phase1 = ((cnf2 >> 3) & 7) + 1;
  const bool phase2_is_set = (cnf2 & map::btlmode) != 0;
  return {(cnf2 & 7) + 1, phase1,
          phase2_is_set ? (cnf3 & 7) + 1 : std::max(phase1, information_processing_time),
          (cnf1 >> 6) + 1};
}

constexpr std::int64_t clocks_per_quantum(std::uint8_t cnf1) {
  return std::int64_t{2} * ((cnf1 & 0x3F) + 1);
}

}  // namespace

NodeTiming Mcp2515Chip::timing() const {
  const std::uint8_t cnf1 = registers_[map::cnf1];
  const Segments s = segments_of(cnf1, registers_[map::cnf2], registers_[map::cnf3]);
  const std::int64_t clocks = clocks_per_quantum(cnf1);
  const std::int64_t before_sample = 1 + s.propagation + s.phase1;
  return {cycles(clocks * (before_sample + s.phase2), options_.osc_hz),
          cycles(clocks * before_sample, options_.osc_hz),
          cycles(clocks * s.jump, options_.osc_hz)};
}

// The rules of 5.3. A PS2 above SJW has the two quanta of the information processing time; that the
// propagation segment be long enough for the cable is nothing that a chip could check.
bool Mcp2515Chip::timing_is_valid() const {
  const Segments s =
      segments_of(registers_[map::cnf1], registers_[map::cnf2], registers_[map::cnf3]);
  return s.propagation + s.phase1 >= s.phase2 && s.phase2 > s.jump;
}

std::uint32_t Mcp2515Chip::bitrate_bps() const {
  const std::uint8_t cnf1 = registers_[map::cnf1];
  const Segments s = segments_of(cnf1, registers_[map::cnf2], registers_[map::cnf3]);
  const std::int64_t clocks = clocks_per_quantum(cnf1) * (1 + s.propagation + s.phase1 + s.phase2);
  return timing_is_valid() ? static_cast<std::uint32_t>(options_.osc_hz / clocks) : 0;
}

void Mcp2515Chip::apply_bit_timing() {
  if (!timing_is_valid()) {
    violation("CNF1..3 break the rules for bit timing");
  }
  bus_.join(controller_, timing());
}

}  // namespace roio::sim
