// Reception of the simulated MCP2515 (4).
#include <algorithm>
#include <roio/sim/mcp2515_chip.hpp>

#include "mcp2515/map.hpp"

namespace roio::sim {
namespace {

constexpr int no_filter = -1;
constexpr std::uint32_t standard_shift = 18;  // where the 11 bits lie among the 29

int mask_of(int filter) {
  return filter < 2 ? 0 : 1;
}

}  // namespace

// SIDH: 28..21 | SIDL: 20..18 in 7..5, 17..16 in 1..0 | EID8: 15..8 | EID0: 7..0
std::uint32_t Mcp2515Chip::identifier_at(std::uint8_t address) const {
  const std::uint32_t sidh = registers_.at(address);
  const std::uint32_t sidl = registers_.at(address + 1U);
  const std::uint32_t eid8 = registers_.at(address + 2U);
  const std::uint32_t eid0 = registers_.at(address + 3U);
  return sidh << 21 | (sidl >> 5) << 18 | (sidl & 3U) << 16 | eid8 << 8 | eid0;
}

// In a standard frame the 16 lower bits look at the first two data bytes (4.5.2).
bool Mcp2515Chip::filter_matches(const Frame& frame, int filter) const {
  const std::uint8_t at = map::filter(filter);
  const bool wants_extended = (registers_.at(at + 1U) & map::exide) != 0;
  if (wants_extended != is_extended(frame.kind)) {
    return false;
  }
  std::uint32_t id = frame.id;
  std::uint32_t compared = 0x1FFFFFFF;
  if (!wants_extended) {
    id = frame.id << standard_shift;
    compared = std::uint32_t{0x7FF} << standard_shift;
    const int bytes = is_remote(frame.kind) ? 0 : frame.length;
    if (bytes > 0) {
      id |= std::uint32_t{frame.data[0]} << 8;
      compared |= 0xFF00;
    }
    if (bytes > 1) {
      id |= frame.data[1];
      compared |= 0x00FF;
    }
  }
  const std::uint32_t mask = identifier_at(map::mask(mask_of(filter)));
  return ((id ^ identifier_at(at)) & mask & compared) == 0;
}

bool Mcp2515Chip::takes_everything() const {
  return mode_ == OperationMode::listen_only && !options_.listen_only_filters;
}

int Mcp2515Chip::matching_filter(const Frame& frame, int buffer) const {
  const std::uint8_t rxm = registers_.at(map::receive_control(buffer)) & map::rxm;
  const int first = buffer == 0 ? 0 : 2;
  if (rxm == map::rxm || takes_everything()) {
    return first;  // any message
  }
  // 01 and 10 were "standard only" and "extended only" once, and are reserved now.
  if ((rxm == 0x20 && is_extended(frame.kind)) || (rxm == 0x40 && !is_extended(frame.kind))) {
    return no_filter;
  }
  const int end = buffer == 0 ? 2 : 6;
  for (int filter = first; filter < end; ++filter) {
    if (filter_matches(frame, filter)) {
      return filter;
    }
  }
  return no_filter;
}

// All eight data bytes of the message assembly buffer move into a receive buffer (4.1): those that
// a frame does not fill are left over from a frame before, accepted or not.
void Mcp2515Chip::assemble(const Frame& frame) {
  const int bytes = is_remote(frame.kind) ? 0 : std::min<int>(frame.length, max_data_length);
  std::copy_n(frame.data, bytes, assembled_.begin());
}

// Figure 4-3: RXB0 has the first look, and RXB1 sees only what RXB0 does not accept.
void Mcp2515Chip::on_received(const Frame& frame) {
  assemble(frame);
  if (const int filter0 = matching_filter(frame, 0); filter0 != no_filter) {
    offer_to_rxb0(frame, filter0);
  } else if (const int filter1 = matching_filter(frame, 1); filter1 != no_filter) {
    offer_to_rxb1(frame, filter1, map::rx1ovr);
  } else {
    ++events_.filtered;
  }
}

// What RXB0 accepts and cannot hold rolls over, when it may.
void Mcp2515Chip::offer_to_rxb0(const Frame& frame, int filter) {
  const bool rolls_over = (registers_.at(map::receive_control(0)) & map::bukt) != 0;
  if (!is_full(0)) {
    store(frame, 0, filter);
  } else if (rolls_over) {
    offer_to_rxb1(frame, filter, options_.full_sets_rx0ovr ? map::rx0ovr : map::rx1ovr);
  } else {
    overflow(map::rx0ovr);
  }
}

void Mcp2515Chip::offer_to_rxb1(const Frame& frame, int filter, std::uint8_t overflow_flag) {
  if (!is_full(1)) {
    store(frame, 1, filter);
  } else {
    overflow(overflow_flag);
  }
}

bool Mcp2515Chip::is_full(int buffer) const {
  return (registers_[map::canintf] & map::rxif(buffer)) != 0;
}

void Mcp2515Chip::overflow(std::uint8_t flag) {
  ++events_.overflowed;
  registers_[map::eflg] |= flag;
  set_flag(map::errif);
}

void Mcp2515Chip::store(const Frame& frame, int buffer, int filter) {
  const std::uint8_t base = map::receive_control(buffer);
  const bool extended = is_extended(frame.kind);
  const bool remote = is_remote(frame.kind);
  const std::uint32_t id = extended ? frame.id : frame.id << standard_shift;
  registers_.at(base + 1U) = static_cast<std::uint8_t>(id >> 21);
  registers_.at(base + 2U) = static_cast<std::uint8_t>(((id >> 13) & 0xE0U) |
                                                       (extended ? map::ide
                                                        : remote ? map::srr
                                                                 : 0U) |
                                                       ((id >> 16) & 3U));
  registers_.at(base + 3U) = static_cast<std::uint8_t>(id >> 8);
  registers_.at(base + 4U) = static_cast<std::uint8_t>(id);
  registers_.at(base + map::dlc) =
      static_cast<std::uint8_t>(frame.length | (extended && remote ? map::rtr : 0U));
  std::copy(assembled_.begin(), assembled_.end(), registers_.begin() + base + map::data);
  const std::uint8_t filter_bits = buffer == 0 ? 1 : 7;
  registers_.at(base) =
      static_cast<std::uint8_t>((registers_.at(base) & ~(filter_bits | map::rxrtr)) |
                                (filter & filter_bits) | (remote ? map::rxrtr : 0U));
  ++events_.accepted;
  if (accepted_listener_) {
    accepted_listener_(frame);
  }
  set_flag(map::rxif(buffer));
}

}  // namespace roio::sim
