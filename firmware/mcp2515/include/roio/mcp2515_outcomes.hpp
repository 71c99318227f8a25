/// What the driver keeps to report what became of each frame; nothing when nobody asks.
#ifndef ROIO_MCP2515_OUTCOMES_HPP
#define ROIO_MCP2515_OUTCOMES_HPP

#include <stdint.h>

#include <roio/mcp2515_frame.hpp>

namespace roio {
namespace mcp2515 {

/// A frame that waits for the chip.
template <bool ReportsOutcomes>
struct Waiting {
  Mcp2515Frame frame;
  uint8_t token;
  void keep(uint8_t t) { token = t; }
  uint8_t kept() const { return token; }
};

template <>
struct Waiting<false> {
  Mcp2515Frame frame;
  static void keep(uint8_t) {}
  static uint8_t kept() { return 0; }
};

/// The frames that the chip has: one token for each transmit buffer, by the buffer's bit in RTS.
template <bool ReportsOutcomes>
class Requests {
 public:
  constexpr Requests() : aborting_(false), again_(0), tokens_() {}
  bool aborting() const { return aborting_; }
  void set_aborting(bool aborting) { aborting_ = aborting; }
  /// Taken back with others, and to be sent all the same: bits TXREQ as in READ STATUS.
  void add_again(uint8_t request) { again_ |= request; }
  uint8_t take_again() {
    const uint8_t again = again_;
    again_ = 0;
    return again;
  }
  void keep(uint8_t buffer, uint8_t token) { tokens_[buffer >> 1] = token; }
  uint8_t token_of(uint8_t buffer) const { return tokens_[buffer >> 1]; }

 private:
  bool aborting_;
  uint8_t again_;
  uint8_t tokens_[3];
};

template <>
class Requests<false> {
 public:
  static bool aborting() { return false; }
  static void set_aborting(bool) {}
  static void add_again(uint8_t) {}
  static uint8_t take_again() { return 0; }
  static void keep(uint8_t, uint8_t) {}
  static uint8_t token_of(uint8_t) { return 0; }
};

}  // namespace mcp2515
}  // namespace roio

#endif
