/// Which transmit buffer the next frame goes to, and with which priority among the three (TXP).
///
/// The chip sends the highest TXP first and, among equals, the highest buffer. Urgent frames have
/// buffer 2 and the highest TXP in use, so one never waits for a normal one to win the bus. Normal
/// frames take turns at buffers 1 and 0, each in a place behind the one before it. A place once
/// passed is not taken again before both buffers are empty: a frame there would overtake.
#ifndef ROIO_MCP2515_ORDER_HPP
#define ROIO_MCP2515_ORDER_HPP

#include <stdint.h>

#include <roio/mcp2515_registers.hpp>

namespace roio {
namespace mcp2515 {

// A transmit buffer by its bit in RTS.
constexpr uint8_t no_buffer = 0;
constexpr uint8_t second_buffer = 1;
constexpr uint8_t first_buffer = 2;
constexpr uint8_t urgent_buffer = 4;

enum class TxPlaces : uint8_t {
  one,  ///< Buffer 0 alone, for urgent and normal frames.
  two,  ///< All have the same TXP: it is written once, if at all.
  six,  ///< TXP falls after each pair, and is written with each frame.
};

/// @param pending what the chip was asked to send, bit for bit TXREQ in READ STATUS.
inline bool is_pending(uint8_t pending, uint8_t buffer) {
  return (pending & QuickStatus::txreq(buffer)) != 0;
}

inline uint8_t unless_pending(uint8_t buffer, uint8_t pending) {
  return is_pending(pending, buffer) ? no_buffer : buffer;
}

/// What TXBnCTRL holds where all have the same: any TXP will do, but not the 0 of a line that says
/// nothing.
constexpr uint8_t common_level = 2;

template <TxPlaces Places>
class TxOrder;

template <>
class TxOrder<TxPlaces::one> {
 public:
  static uint8_t choose(bool, uint8_t pending) { return pending == 0 ? second_buffer : no_buffer; }
  static uint8_t level_of(uint8_t) { return common_level; }
};

template <>
class TxOrder<TxPlaces::two> {
 public:
  static uint8_t choose(bool urgent, uint8_t pending) {
    if (urgent) {
      return unless_pending(urgent_buffer, pending);
    }
    if (is_pending(pending, second_buffer)) {
      return no_buffer;
    }
    return is_pending(pending, first_buffer) ? second_buffer : first_buffer;
  }
  static uint8_t level_of(uint8_t) { return common_level; }
};

template <>
class TxOrder<TxPlaces::six> {
 public:
  constexpr TxOrder() : place_(0), levels_{top, top} {}

  /// The caller loads the buffer that this names.
  uint8_t choose(bool urgent, uint8_t pending) {
    if (urgent) {
      return unless_pending(urgent_buffer, pending);
    }
    if (!is_pending(pending, first_buffer) && !is_pending(pending, second_buffer)) {
      place_ = 0;
    }
    const uint8_t buffer = (place_ & 1U) == 0 ? first_buffer : second_buffer;
    if (place_ == places || is_pending(pending, buffer)) {
      return no_buffer;
    }
    levels_[buffer & 1U] = static_cast<uint8_t>(top - (place_ >> 1));
    ++place_;
    return buffer;
  }
  uint8_t level_of(uint8_t buffer) const {
    return buffer == urgent_buffer ? top : levels_[buffer & 1U];
  }

 private:
  static constexpr uint8_t top = 3;
  static constexpr uint8_t places = 6;  // not eight: a line that says nothing answers with 0

  uint8_t place_;      // of the next normal frame
  uint8_t levels_[2];  // of buffers 1 and 0
};

}  // namespace mcp2515
}  // namespace roio

#endif
