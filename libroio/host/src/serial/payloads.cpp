#include "serial/payloads.hpp"

#include <array>

namespace roio::serial {
namespace {

void append32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

}  // namespace

std::vector<std::uint8_t> speed_payload(std::uint32_t rate_bps) {
  std::vector<std::uint8_t> payload;
  append32(payload, rate_bps);
  return payload;
}

std::vector<std::uint8_t> bus_payload(std::uint32_t bitrate_bps, BridgeMode mode) {
  std::vector<std::uint8_t> payload;
  append32(payload, bitrate_bps);
  payload.push_back(static_cast<std::uint8_t>(mode));
  return payload;
}

std::vector<std::uint8_t> filter_payload(const std::vector<Rule>& rules) {
  std::vector<std::uint8_t> payload{static_cast<std::uint8_t>(rules.size())};
  for (const Rule& rule : rules) {
    append32(payload, rule.match);
    append32(payload, rule.mask);
  }
  return payload;
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
