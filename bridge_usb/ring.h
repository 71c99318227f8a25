/// Ring: 255 bytes between an interrupt and the program, whose indices wrap by themselves.
#ifndef ROIO_BRIDGE_RING_H
#define ROIO_BRIDGE_RING_H

#include <stdint.h>

namespace roio {
namespace bridge {

constexpr uint16_t ring_size = 256;

/// Where a ring begins and ends. One side writes head, the other tail; each is one byte, so neither
/// is ever seen half written.
struct RingEnds {
  volatile uint8_t head;  // where the next byte goes
  volatile uint8_t tail;  // where the oldest is

  uint8_t size() const { return static_cast<uint8_t>(head - tail); }
  uint8_t room() const { return static_cast<uint8_t>(tail - head - 1U); }
};

}  // namespace bridge
}  // namespace roio

#endif
