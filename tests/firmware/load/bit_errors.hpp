/// Echo on a bus with bit errors, and what became of every message.
#ifndef ROIO_TESTS_FIRMWARE_LOAD_BIT_ERRORS_HPP
#define ROIO_TESTS_FIRMWARE_LOAD_BIT_ERRORS_HPP

#include <cstdint>
#include <roio/sim/time.hpp>

namespace roio::load {

struct BitErrorReport {
  // On the way to Echo. CAN itself repeats or omits a frame when the errors hit its last bits, and
  // once in many thousands of hits its CRC misses one.
  std::uint64_t sent = 0;        ///< By the PC, and acknowledged.
  std::uint64_t accepted = 0;    ///< By the chip.
  std::uint64_t repeated = 0;    ///< Of these: the same as the one before.
  std::uint64_t missing = 0;     ///< Sent, and not accepted: overflowed, omitted or corrupted.
  std::uint64_t overflowed = 0;  ///< Times that both buffers were full.
  std::uint64_t corrupted = 0;   ///< Accepted, and not what was sent.
  // In Echo, by its own counters, modulo 65536.
  std::uint16_t echo_received = 0;
  std::uint16_t echo_foreign = 0;
  std::uint16_t echo_overflows = 0;
  std::uint16_t echo_sent = 0;
  std::uint16_t echo_unknown = 0;
  std::uint16_t echo_chip_losses = 0;
  std::uint16_t echo_keeps = 0;  ///< Messages not sent yet.
  // On the way back.
  std::uint64_t chip_sent = 0;
  std::uint64_t back = 0;           ///< To the PC.
  std::uint64_t back_repeated = 0;  ///< Of these.
  std::uint64_t back_missing = 0;   ///< Neither missing there nor back.
  std::uint64_t back_corrupted = 0;
  std::uint64_t disordered = 0;  ///< Came back after a later one.
  // What the bus went through.
  std::uint64_t flipped_bits = 0;
  std::uint64_t transmit_errors = 0;
  std::uint64_t chip_bus_offs = 0;
  std::uint64_t pc_bus_offs = 0;
  bool alive =
      false;  ///< Once the errors had stopped: 100 messages came back, in order, none lost.
};

/// @param probability of an error, for each bit.
BitErrorReport echo_under_bit_errors(double probability, std::uint32_t seed, sim::SimTime span);

}  // namespace roio::load

#endif
