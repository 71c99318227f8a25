// Transmission of the simulated MCP2515 (3).
#include <roio/frame_length.hpp>
#include <roio/sim/mcp2515_chip.hpp>
#include <utility>

#include "mcp2515/map.hpp"

namespace roio::sim {

void Mcp2515Chip::request_transmission(int buffer) {
  std::uint8_t& control = registers_.at(map::transmit_control(buffer));
  if ((control & map::txreq) != 0) {
    return;
  }
  control = static_cast<std::uint8_t>((control & map::txp) | map::txreq);
  requested_at_.at(static_cast<std::size_t>(buffer)) = bus_.now();
  if ((registers_[map::canctrl] & map::abat) != 0) {
    return give_up(buffer, map::abtf);
  }
  if (is_looping_back()) {
    // Not before all the buffers that one instruction names are pending.
    later(SimTime(0), [this] { start_loopback(); });
  } else {
    controller_.request();
  }
}

// One buffer taken back by clearing its TXREQ. A message that has begun goes on all the same, and
// is not repeated when it fails. ABTF stays as it was (3.6).
void Mcp2515Chip::take_back(int buffer) {
  registers_.at(map::transmit_control(buffer)) &= static_cast<std::uint8_t>(~map::txreq);
  if (on_wire_ != buffer) {
    give_up(buffer, 0);
    update_mode();
  }
}

// All of them taken back by ABAT: what has begun keeps its TXREQ until it has come to its end
// (3.6).
void Mcp2515Chip::abort_all() {
  for (int buffer = 0; buffer < 3; ++buffer) {
    if (is_pending(buffer) && on_wire_ != buffer) {
      give_up(buffer, map::abtf);
    }
  }
}

void Mcp2515Chip::give_up(int buffer, std::uint8_t flags) {
  std::uint8_t& control = registers_.at(map::transmit_control(buffer));
  control = static_cast<std::uint8_t>((control & ~map::txreq) | flags);
  ++events_.aborted;
}

bool Mcp2515Chip::is_pending(int buffer) const {
  return (registers_.at(map::transmit_control(buffer)) & map::txreq) != 0;
}

// The highest priority and, among equals, the highest buffer (3.2).
int Mcp2515Chip::next_buffer() const {
  int best = -1;
  int best_priority = -1;
  for (int buffer = 0; buffer < 3; ++buffer) {
    const int priority = registers_.at(map::transmit_control(buffer)) & map::txp;
    if (is_pending(buffer) && priority >= best_priority) {
      best = buffer;
      best_priority = priority;
    }
  }
  return best;
}

Frame Mcp2515Chip::transmit_frame(int buffer) const {
  const std::uint8_t base = map::transmit_control(buffer);
  const bool extended = (registers_.at(base + map::sidl) & map::exide) != 0;
  const bool remote = (registers_.at(base + map::dlc) & map::rtr) != 0;
  const std::uint32_t id = identifier_at(static_cast<std::uint8_t>(base + map::sidh));
  Frame frame{};
  frame.id = extended ? id : id >> 18;
  frame.kind = extended ? (remote ? FrameKind::extended_remote : FrameKind::extended)
                        : (remote ? FrameKind::standard_remote : FrameKind::standard);
  frame.length = registers_.at(base + map::dlc) & map::dlc_bits;
  for (std::uint8_t i = 0; i < max_data_length; ++i) {
    frame.data[i] = registers_.at(static_cast<std::size_t>(base + map::data + i));
  }
  return frame;
}

std::optional<Submission> Mcp2515Chip::next_submission() {
  on_wire_ = next_buffer();
  if (on_wire_ < 0) {
    return std::nullopt;
  }
  return Submission{transmit_frame(on_wire_), requested_at_.at(static_cast<std::size_t>(on_wire_))};
}

void Mcp2515Chip::transmission_done(const Frame& frame) {
  const int buffer = std::exchange(on_wire_, -1);
  registers_.at(map::transmit_control(buffer)) &= static_cast<std::uint8_t>(~map::txreq);
  ++events_.sent;
  set_flag(map::txif(buffer));
  if (sent_listener_) {
    sent_listener_(frame);
  }
}

void Mcp2515Chip::on_transmitted() {
  transmission_done(controller_.submission().frame);
  update_mode();
}

// An attempt came to nothing: the chip tries again, unless told otherwise.
void Mcp2515Chip::end_attempt(std::uint8_t error_flag) {
  const int buffer = std::exchange(on_wire_, -1);
  registers_.at(map::transmit_control(buffer)) |= error_flag;
  const bool all_taken_back = (registers_[map::canctrl] & (map::abat | map::osm)) != 0;
  if (!is_pending(buffer)) {
    ++events_.aborted;
  } else if (all_taken_back) {
    give_up(buffer, map::abtf);
  }
}

void Mcp2515Chip::on_arbitration_lost() {
  end_attempt(map::mloa);
  update_mode();
}

void Mcp2515Chip::on_transmit_error(BusError /*error*/) {
  end_attempt(map::txerr);
  set_flag(map::merrf);
  update_mode();
}

// --- loopback mode: a bus of its own, that takes as long (10.4) ----------------------------------

// Not any more on the way to another mode: from then on the controller takes what is pending.
bool Mcp2515Chip::is_looping_back() const {
  return mode_ == OperationMode::loopback && !entering_;
}

void Mcp2515Chip::start_loopback() {
  if (!is_looping_back() || on_wire_ >= 0) {
    return;
  }
  on_wire_ = next_buffer();
  if (on_wire_ >= 0) {
    const Frame frame = transmit_frame(on_wire_);
    later(timing().bit * wire_bits(frame), [this, frame] { finish_loopback(frame); });
  }
}

void Mcp2515Chip::finish_loopback(const Frame& frame) {
  transmission_done(frame);
  on_received(frame);
  update_mode();
  start_loopback();
}

}  // namespace roio::sim
