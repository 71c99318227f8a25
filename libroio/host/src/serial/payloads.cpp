#include "serial/payloads.hpp"

#include <array>
#include <roio/serial_record.hpp>

namespace roio::serial {
namespace {

std::vector<std::uint8_t> bytes_of(const Body& body) {
  return {body.bytes(), body.bytes() + body.length()};
}

}  // namespace

std::vector<std::uint8_t> speed_payload(std::uint32_t rate_bps) {
  Body payload;
  payload.put32(rate_bps);
  return bytes_of(payload);
}

std::vector<std::uint8_t> bus_payload(std::uint32_t bitrate_bps, BridgeMode mode) {
  Body payload;
  payload.put32(bitrate_bps);
  payload.put(static_cast<std::uint8_t>(mode));
  return bytes_of(payload);
}

std::vector<std::uint8_t> filter_payload(const std::vector<Rule>& rules) {
  Body payload;
  payload.put(static_cast<std::uint8_t>(rules.size()));
  for (const Rule& rule : rules) {
    payload.put32(rule.match);
    payload.put32(rule.mask);
  }
  return bytes_of(payload);
}

std::vector<std::uint8_t> echo_payload(unsigned number) {
  constexpr std::size_t length = 24;
  constexpr std::array<std::uint8_t, 3> constant{0x00, 0xFF, 0x55};
  std::vector<std::uint8_t> payload(length);
  for (std::size_t i = 0; i < payload.size(); ++i) {
    payload[i] =
        number < constant.size() ? constant.at(number) : static_cast<std::uint8_t>(i * 0x9D + 0x6B);
  }
  payload[0] = static_cast<std::uint8_t>(number);
  return payload;
}

}  // namespace roio::serial
