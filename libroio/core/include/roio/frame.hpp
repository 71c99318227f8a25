/// Frame: one classic CAN frame of any kind, as it is on the bus. What Roio makes of it is
/// message.hpp's.
#ifndef ROIO_FRAME_HPP
#define ROIO_FRAME_HPP

#include <stdint.h>

namespace roio {

constexpr uint8_t max_data_length = 8;

/// What kind of frame; the value is bits 31..29 of the tagged identifier, which are SocketCAN's
/// flags:
///   bit 31 extended identifier | bit 30 remote request | bit 29 error report (never on the wire)
enum class FrameKind : uint8_t {
  standard = 0,         ///< 11-bit identifier, data.
  error = 1,            ///< A controller's report to its host; id is the error class.
  standard_remote = 2,  ///< 11-bit identifier, remote request.
  extended = 4,         ///< 29-bit identifier, data: the only kind that can carry a Roio message.
  extended_remote = 6,  ///< 29-bit identifier, remote request.
};

constexpr bool is_extended(FrameKind kind) {
  return (static_cast<uint8_t>(kind) & 4U) != 0;
}
constexpr bool is_remote(FrameKind kind) {
  return (static_cast<uint8_t>(kind) & 2U) != 0;
}

struct Frame {
  uint32_t id;  ///< 0..0x7FF for the standard kinds, 0..0x1FFFFFFF for the others.
  FrameKind kind;
  uint8_t length;  ///< 0..8; of a remote frame, the length asked for (it carries no data).
  uint8_t data[max_data_length];
};

/// Kind and identifier in one word, bit for bit SocketCAN's can_id.
constexpr uint32_t tagged_id(FrameKind kind, uint32_t id) {
  return (static_cast<uint32_t>(kind) << 29) | id;
}
constexpr uint32_t tagged_id(const Frame& frame) {
  return tagged_id(frame.kind, frame.id);
}

/// The largest identifier of a kind.
constexpr uint32_t max_id(FrameKind kind) {
  return kind == FrameKind::standard || kind == FrameKind::standard_remote ? UINT32_C(0x7FF)
                                                                           : UINT32_C(0x1FFFFFFF);
}

/// Whether kind, identifier and length are ones that a bus can carry (error reports included).
constexpr bool is_valid(const Frame& frame) {
  return (frame.kind == FrameKind::standard || frame.kind == FrameKind::error ||
          frame.kind == FrameKind::standard_remote || frame.kind == FrameKind::extended ||
          frame.kind == FrameKind::extended_remote) &&
         frame.id <= max_id(frame.kind) && frame.length <= max_data_length;
}

/// The arbitration field as the bus compares it, first bit highest: of two frames that start
/// together, the one with the smaller key wins.
///
///   standard:  31........21 | 20  | 19  | 18..................0
///              identifier   | RTR | IDE | 0 (both past it)
///   extended:  31........21 | 20  | 19  | 18...........1 | 0
///              id 28..18    | SRR | IDE | id 17..0       | RTR
/// Source: ISO 11898-1 frame formats. An error report takes no part in arbitration.
constexpr uint32_t arbitration_key(FrameKind kind, uint32_t id) {
  return is_extended(kind) ? ((id >> 18) << 21) | (UINT32_C(3) << 19) |
                                 ((id & UINT32_C(0x3FFFF)) << 1) | (is_remote(kind) ? 1U : 0U)
                           : (id << 21) | (is_remote(kind) ? UINT32_C(1) << 20 : 0U);
}
constexpr uint32_t arbitration_key(const Frame& frame) {
  return arbitration_key(frame.kind, frame.id);
}

}  // namespace roio

#endif
