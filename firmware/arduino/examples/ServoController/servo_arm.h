// Made by `roio-cli kind header` from servo-arm.kind.json: change that, and make this again.
//
// servo-arm: Three servos, moved by messages: the Arduino example ServoController
//
// A message is a struct of what is on the wire, and there are, for each:
//
//   bool pack(const Message& from, uint8_t* bytes)
//     writes length_of(from) bytes, NAME::length of them at most. False when a value is out of
//     range: then it writes none.
//   bool unpack(const uint8_t* bytes, uint8_t length, Message& to)
//   bool unpack(const Roio::Message& message, Message& to)
//     False when length or tag are another message's, or a value is out of range: then `to` stays
//     as it is.
//   NAME::length, NAME::tag, NAME::FIELD::minimum and maximum: on the wire. A value in its unit is
//     what is on the wire, times NAME::FIELD::numerator, divided by NAME::FIELD::denominator.
//
// No heap, no floats, nothing but <stdint.h>.
#ifndef ROIO_KIND_SERVO_ARM_H
#define ROIO_KIND_SERVO_ARM_H

#include <stdint.h>

namespace servo_arm {

// What such a board understands.
namespace heard {

// --- angles: 3 bytes

/// Moves all three; nothing moves when one is out of range
struct Angles {
  uint8_t shoulder;  ///< 0 to 180 deg
  uint8_t elbow;     ///< 0 to 180 deg
  uint8_t hand;      ///< 0 to 180 deg
};

namespace angles {
constexpr uint8_t length = 3;
namespace shoulder {
constexpr uint8_t minimum = 0, maximum = 180;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace shoulder
namespace elbow {
constexpr uint8_t minimum = 0, maximum = 180;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace elbow
namespace hand {
constexpr uint8_t minimum = 0, maximum = 180;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace hand
}  // namespace angles

constexpr uint8_t length_of(const Angles&) {
  return 3;
}
inline bool pack(const Angles& from, uint8_t* bytes) {
  if (from.shoulder > 180 || from.elbow > 180 || from.hand > 180) {
    return false;
  }
  bytes[0] = from.shoulder;
  bytes[1] = from.elbow;
  bytes[2] = from.hand;
  return true;
}
inline bool unpack(const uint8_t* bytes, uint8_t length, Angles& to) {
  if (length != 3) {
    return false;
  }
  Angles read;
  read.shoulder = bytes[0];
  read.elbow = bytes[1];
  read.hand = bytes[2];
  if (read.shoulder > 180 || read.elbow > 180 || read.hand > 180) {
    return false;
  }
  to = read;
  return true;
}
template <typename AnyMessage>
bool unpack(const AnyMessage& message, Angles& to) {
  return unpack(message.data(), message.length(), to);
}

// --- refusals: 0 bytes

/// Asks how many messages were refused
struct Refusals {};

namespace refusals {
constexpr uint8_t length = 0;
}  // namespace refusals

constexpr uint8_t length_of(const Refusals&) {
  return 0;
}
inline bool pack(const Refusals&, uint8_t*) {
  return true;
}
inline bool unpack(const uint8_t*, uint8_t length, Refusals&) {
  return length == 0;
}
template <typename AnyMessage>
bool unpack(const AnyMessage& message, Refusals& to) {
  return unpack(message.data(), message.length(), to);
}

}  // namespace heard

// What such a board sends.
namespace said {

// --- refusals: 2 bytes

/// How many messages were refused; 0 follows 65535
struct Refusals {
  uint16_t count;  ///< 0 to 65535
};

namespace refusals {
constexpr uint8_t length = 2;
namespace count {
constexpr uint16_t minimum = 0, maximum = 65535U;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace count
}  // namespace refusals

constexpr uint8_t length_of(const Refusals&) {
  return 2;
}
inline bool pack(const Refusals& from, uint8_t* bytes) {
  bytes[0] = static_cast<uint8_t>(from.count >> 8);
  bytes[1] = static_cast<uint8_t>(from.count);
  return true;
}
inline bool unpack(const uint8_t* bytes, uint8_t length, Refusals& to) {
  if (length != 2) {
    return false;
  }
  Refusals read;
  read.count = static_cast<uint16_t>((static_cast<uint16_t>(bytes[0]) << 8) | bytes[1]);
  to = read;
  return true;
}
template <typename AnyMessage>
bool unpack(const AnyMessage& message, Refusals& to) {
  return unpack(message.data(), message.length(), to);
}

}  // namespace said

}  // namespace servo_arm

#endif
