/// Frames from the chip's bytes into the bodies of records, and back: no word is ever put together,
/// which an AVR would do byte by byte and bit by bit.
///
///   bits of the identifier in each byte
///          extended                               standard
///          tag           chip                     tag        chip
///     0    kind 28..24   28..21                   kind 0     10..3
///     1    23..16        20..18 SRR EXIDE 17..16  0          2..0
///     2    15..8         15..8                    10..8      0
///     3    7..0          7..0                     7..0       0
///
/// Source: docs/internals/serial-protocol.md "Frames"; mcp2515_frame.hpp.
#ifndef ROIO_BRIDGE_FRAME_BODY_H
#define ROIO_BRIDGE_FRAME_BODY_H

#include "config.h"

namespace roio {
namespace bridge {

/// Down: the chip's bytes of a frame, from the body of its record.
/// @return false: none that a bus carries.
inline bool read_frame_body(const uint8_t* body, uint8_t length, Mcp2515Frame& frame) {
  const uint8_t kind = body[0] & serial::control_bits;
  const uint8_t payload = static_cast<uint8_t>(length - serial::frame_head_down);
  uint8_t* chip = frame.bytes;
  if (length < serial::frame_head_down || (kind & 0x20) != 0) {
    return false;
  }
  if ((kind & 0x80) != 0) {
    chip[0] = static_cast<uint8_t>((body[0] << 3) | (body[1] >> 5));
    chip[1] = static_cast<uint8_t>(((body[1] << 3) & 0xE0) | Mcp2515Frame::extended_bit |
                                   (body[1] & 0x03));
    chip[2] = body[2];
    chip[3] = body[3];
  } else {
    if ((body[0] & 0x1F) != 0 || body[1] != 0 || body[2] > 7) {
      return false;
    }
    chip[0] = static_cast<uint8_t>((body[2] << 5) | (body[3] >> 3));
    chip[1] = static_cast<uint8_t>(body[3] << 5);
    chip[2] = 0;
    chip[3] = 0;
  }
  body += serial::frame_head_down;
  if ((kind & 0x40) != 0) {
    chip[4] = static_cast<uint8_t>(*body | Mcp2515Frame::remote_bit);
    return payload == 1 && *body <= max_data_length;
  }
  if (payload > max_data_length) {
    return false;
  }
  chip[4] = payload;
  uint8_t* data = frame.data();
  for (uint8_t left = payload; left != 0; --left) {
    *data++ = *body++;
  }
  return true;
}

/// Up: the tag, with which the body of a frame's record begins.
/// @param remote frame.is_remote(). @param tag 4 bytes.
inline void put_tag(const Mcp2515Frame& frame, bool remote, uint8_t* tag) {
  const uint8_t first = frame.bytes[0];
  const uint8_t second = frame.bytes[1];
  uint8_t kind = remote ? 0x40 : 0x00;
  if (frame.is_extended()) {
    const uint8_t high = first >> 3;
    const uint8_t middle = static_cast<uint8_t>(first << 5);
    const uint8_t low = second >> 3;
    kind |= 0x80;
    tag[0] = kind | high;
    tag[1] = static_cast<uint8_t>(middle | (low & 0x1C) | (second & 0x03));
    tag[2] = frame.bytes[2];
    tag[3] = frame.bytes[3];
  } else {
    tag[0] = kind;
    tag[1] = 0;
    tag[2] = static_cast<uint8_t>(first >> 5);
    tag[3] = static_cast<uint8_t>((first << 3) | (second >> 5));
  }
}

}  // namespace bridge
}  // namespace roio

#endif
