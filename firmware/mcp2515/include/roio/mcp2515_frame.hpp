/// Mcp2515Frame: a frame as the MCP2515 keeps it in its buffers, so that it goes over SPI as it is.
///
///   byte | 7       6      5      4      3      2      1      0
///   -----+----------------------------------------------------
///   0    | id 28 .. 21                                            SIDH
///   1    | id 20 .. 18          SRR    EXIDE  -      id 17 16    SIDL
///   2    | id 15 .. 8                                            EID8
///   3    | id 7 .. 0                                             EID0
///   4    | -       RTR    -      -      length                   DLC
///   5..  | data
///
/// Source: MCP2515 datasheet DS20001801, registers 3-3 to 3-8, 4-4 to 4-8. Where the fields of a
/// Roio header lie in these follows from docs/protocol.md "Header".
#ifndef ROIO_MCP2515_FRAME_HPP
#define ROIO_MCP2515_FRAME_HPP

#include <stdint.h>

#include <roio/filter_mcp2515.hpp>
#include <roio/frame.hpp>
#include <roio/message.hpp>

namespace roio {

struct Mcp2515Frame {
  static constexpr uint8_t head_length = 5;
  static constexpr uint8_t extended_bit = 0x08;  ///< Of byte 1.
  static constexpr uint8_t standard_remote_bit =
      0x10;                                    ///< Of byte 1, received standard frames only.
  static constexpr uint8_t remote_bit = 0x40;  ///< Of byte 4: to send, and extended ones.
  static constexpr uint8_t length_mask = 0x0F;

  uint8_t bytes[head_length + max_data_length];

  uint8_t* data() { return bytes + head_length; }
  const uint8_t* data() const { return bytes + head_length; }
  __attribute__((always_inline)) bool is_extended() const { return (bytes[1] & extended_bit) != 0; }
  __attribute__((always_inline)) bool is_remote() const {
    return is_extended() ? (bytes[4] & remote_bit) != 0 : (bytes[1] & standard_remote_bit) != 0;
  }
  /// 0..8 in a frame that the driver handed out.
  uint8_t length() const { return bytes[4] & length_mask; }
  /// A DLC of 9 to 15 means 8 (ISO 11898-1), and what bits 5 and 4 hold is nobody's business.
  void limit_length() {
    uint8_t dlc = bytes[4];
    if ((dlc & max_data_length) != 0) {
      dlc &= static_cast<uint8_t>(~(max_data_length - 1U));  // 9 to 15
    }
    bytes[4] = dlc & (remote_bit | length_mask);
  }
};

namespace mcp2515 {

constexpr uint8_t standard_id_shift = 18;  ///< Where the 11 bits lie among the 29.

/// @param frame is_valid(), and no error report.
inline Mcp2515Frame to_chip(const Frame& frame) {
  Mcp2515Frame out;
  const bool extended = is_extended(frame.kind);
  to_mcp2515_registers(extended ? frame.id : frame.id << standard_id_shift, out.bytes);
  if (extended) {
    out.bytes[1] = static_cast<uint8_t>(out.bytes[1] | Mcp2515Frame::extended_bit);
  }
  out.bytes[4] =
      static_cast<uint8_t>(frame.length | (is_remote(frame.kind) ? Mcp2515Frame::remote_bit : 0U));
  for (uint8_t i = 0; i < max_data_length; ++i) {
    out.data()[i] = frame.data[i];
  }
  return out;
}

inline Frame from_chip(const Mcp2515Frame& frame) {
  Frame out;
  const bool remote = frame.is_remote();
  out.id = from_mcp2515_registers(frame.bytes);
  if (frame.is_extended()) {
    out.kind = remote ? FrameKind::extended_remote : FrameKind::extended;
  } else {
    out.id >>= standard_id_shift;
    out.kind = remote ? FrameKind::standard_remote : FrameKind::standard;
  }
  out.length = frame.length();
  for (uint8_t i = 0; i < max_data_length; ++i) {
    out.data[i] = !remote && i < out.length ? frame.data()[i] : uint8_t{0};
  }
  return out;
}

//   byte 0: priority | class | destination subnet    byte 2: node 2..0 | source subnet
//   byte 1: destination node 7..5 | - | node 4 3     byte 3: source node
inline Priority priority_of(const Mcp2515Frame& frame) {
  return static_cast<Priority>(frame.bytes[0] >> 7);
}
inline Address destination_of(const Mcp2515Frame& frame) {
  const uint8_t* head = frame.bytes;
  return Address{static_cast<uint8_t>(head[0] & max_subnet),
                 static_cast<uint8_t>((head[1] & 0xE0U) | ((head[1] & 3U) << 3) | (head[2] >> 5))};
}
inline Address source_of(const Mcp2515Frame& frame) {
  return Address{static_cast<uint8_t>(frame.bytes[2] & max_subnet), frame.bytes[3]};
}

constexpr uint8_t class_bits = 0x60;    ///< Of byte 0; MessageClass::message is 0.
constexpr uint8_t priority_bit = 0x80;  ///< Of byte 0.

/// Whether an extended frame is a message of the user's, from an address that a node can have.
inline bool is_message(const Mcp2515Frame& frame) {
  return (frame.bytes[0] & class_bits) == 0 && frame.bytes[3] != broadcast_node;
}

/// An extended frame of class message. A subnet that is none becomes a class that is not a message:
/// can_be_sent() refuses it.
inline void put_destination(Address destination, Mcp2515Frame& frame) {
  const uint8_t subnet = destination.subnet <= max_subnet ? destination.subnet : class_bits;
  // Moved by 5 bits: what byte 1 has at its end, and what byte 2 begins with.
  const uint16_t wide = static_cast<uint16_t>(destination.node * 32U);
  frame.bytes[0] = static_cast<uint8_t>((frame.bytes[0] & priority_bit) | subnet);
  frame.bytes[1] = static_cast<uint8_t>((destination.node & 0xE0U) | Mcp2515Frame::extended_bit |
                                        ((wide >> 8) & 3U));
  frame.bytes[2] = static_cast<uint8_t>((frame.bytes[2] & max_subnet) | static_cast<uint8_t>(wide));
}
inline void put_source(Address source, Mcp2515Frame& frame) {
  frame.bytes[2] = static_cast<uint8_t>((frame.bytes[2] & 0xE0U) | source.subnet);
  frame.bytes[3] = source.node;
}
inline bool can_be_sent(const Mcp2515Frame& frame) {
  return (frame.bytes[0] & class_bits) == 0 && frame.bytes[4] <= max_data_length;
}

}  // namespace mcp2515
}  // namespace roio

#endif
