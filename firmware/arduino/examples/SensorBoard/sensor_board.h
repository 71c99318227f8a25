// Made by `roio-cli kind header` from sensor-board.kind.json: change that, and make this again.
//
// sensor-board: A light sensor, two buttons, three potentiometers: the Arduino example SensorBoard
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
#ifndef ROIO_KIND_SENSOR_BOARD_H
#define ROIO_KIND_SENSOR_BOARD_H

#include <stdint.h>

namespace sensor_board {

// What such a board sends.
namespace said {

// --- values: 6 bytes

/// Told at the start, and when one has changed
struct Values {
  uint8_t light;    ///< 0 to 255
  uint8_t button1;  ///< 0 to 255: Clicks; 0 follows 255
  uint8_t button2;  ///< 0 to 255: Clicks; 0 follows 255
  uint8_t pot1;     ///< 0 to 255
  uint8_t pot2;     ///< 0 to 255
  uint8_t pot3;     ///< 0 to 255
};

namespace values {
constexpr uint8_t length = 6;
namespace light {
constexpr uint8_t minimum = 0, maximum = 255;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace light
namespace button1 {
constexpr uint8_t minimum = 0, maximum = 255;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace button1
namespace button2 {
constexpr uint8_t minimum = 0, maximum = 255;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace button2
namespace pot1 {
constexpr uint8_t minimum = 0, maximum = 255;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace pot1
namespace pot2 {
constexpr uint8_t minimum = 0, maximum = 255;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace pot2
namespace pot3 {
constexpr uint8_t minimum = 0, maximum = 255;
constexpr uint32_t numerator = 1, denominator = 1;
}  // namespace pot3
}  // namespace values

constexpr uint8_t length_of(const Values&) {
  return 6;
}
inline bool pack(const Values& from, uint8_t* bytes) {
  bytes[0] = from.light;
  bytes[1] = from.button1;
  bytes[2] = from.button2;
  bytes[3] = from.pot1;
  bytes[4] = from.pot2;
  bytes[5] = from.pot3;
  return true;
}
inline bool unpack(const uint8_t* bytes, uint8_t length, Values& to) {
  if (length != 6) {
    return false;
  }
  Values read;
  read.light = bytes[0];
  read.button1 = bytes[1];
  read.button2 = bytes[2];
  read.pot1 = bytes[3];
  read.pot2 = bytes[4];
  read.pot3 = bytes[5];
  to = read;
  return true;
}
template <typename AnyMessage>
bool unpack(const AnyMessage& message, Values& to) {
  return unpack(message.data(), message.length(), to);
}

}  // namespace said

}  // namespace sensor_board

#endif
