/// What the tests of the bus share: its rate, the frame of docs/protocol.md, a sender without end.
#ifndef ROIO_TESTS_CAN_BUS_RIG_HPP
#define ROIO_TESTS_CAN_BUS_RIG_HPP

#include <cstdint>
#include <roio/sim/can_bus.hpp>
#include <string>
#include <vector>

#include "station.hpp"

namespace roio::sim {

using test::Station;
using test::text_of;
using Texts = std::vector<std::string>;

inline constexpr std::uint32_t rate = 500'000;
inline const SimTime bit = cycles(1, rate);
inline const Frame document_frame{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};

inline Frame extended(std::uint32_t id, std::uint8_t data = 0) {
  return {id, FrameKind::extended, 1, {data}};
}

/// One frame after the other from one station, as many as there is time for.
inline void send_without_end(Station& station, const Frame& frame) {
  station.node.on_sent([&station, frame](const Frame&) { station.node.send(frame); });
  station.node.send(frame);
}

}  // namespace roio::sim

#endif
