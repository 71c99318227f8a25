/// What the PC asks of a bridge, in bytes. Source: docs/internals/serial-protocol.md "Down".
#ifndef ROIO_SERIAL_PAYLOADS_HPP
#define ROIO_SERIAL_PAYLOADS_HPP

#include <cstdint>
#include <roio/bridge.hpp>
#include <vector>

namespace roio::serial {

/// One rule of FILTER, compared as tags (frame.hpp).
struct Rule {
  std::uint32_t match;
  std::uint32_t mask;
};

/// Behind the request's number.
std::vector<std::uint8_t> speed_payload(std::uint32_t rate_bps);
std::vector<std::uint8_t> bus_payload(std::uint32_t bitrate_bps, BridgeMode mode);
std::vector<std::uint8_t> filter_payload(const std::vector<Rule>& rules);

/// How many different ones a trial of a line rate sends.
constexpr unsigned echo_count = 4;
/// All levels and edges: zeros, ones, alternating bits, and all kinds of bytes; short, so that it
/// finds room in a bridge whose bus is busy. @param number 0..echo_count - 1, is its first byte.
std::vector<std::uint8_t> echo_payload(unsigned number);

}  // namespace roio::serial

#endif
