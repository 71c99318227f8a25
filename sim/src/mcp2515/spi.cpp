// The nine SPI instructions of the simulated MCP2515 (12).
#include <roio/sim/mcp2515_chip.hpp>

#include "mcp2515/map.hpp"

namespace roio::sim {
namespace {

constexpr std::uint8_t reset_code = 0b1100'0000;
constexpr std::uint8_t read_code = 0b0000'0011;
constexpr std::uint8_t write_code = 0b0000'0010;
constexpr std::uint8_t bit_modify_code = 0b0000'0101;
constexpr std::uint8_t read_status_code = 0b1010'0000;
constexpr std::uint8_t receive_status_code = 0b1011'0000;

// Instructions with something in their low bits.
constexpr bool is_read_buffer(std::uint8_t code) {
  return (code & 0b1111'1001) == 0b1001'0000;
}
constexpr bool is_load_buffer(std::uint8_t code) {
  return (code & 0b1111'1000) == 0b0100'0000 && (code & 7) < 6;
}
constexpr bool is_request_to_send(std::uint8_t code) {
  return (code & 0b1111'1000) == 0b1000'0000;
}

// The address wraps around at the end of the register file.
constexpr std::uint8_t after(std::uint8_t address) {
  return (address + 1U) & (map::register_count - 1U);
}

}  // namespace

void Mcp2515Chip::select() {
  if (selected_) {
    violation("chip select lowered twice");
  }
  selected_ = true;
  instruction_ = {};
}

// An instruction takes effect byte by byte, except for what waits for chip select to rise.
void Mcp2515Chip::deselect() {
  if (!selected_) {
    return;
  }
  selected_ = false;
  const Instruction done = instruction_;
  instruction_ = {};
  if (!running_) {
    return;
  }
  if (done.frees != 0) {
    registers_[map::canintf] &= static_cast<std::uint8_t>(~done.frees);
    update_pins();
  }
  for (int buffer = 0; buffer < 3; ++buffer) {
    if (((done.requests >> buffer) & 1) != 0) {
      request_transmission(buffer);
    }
  }
}

std::uint8_t Mcp2515Chip::exchange(std::uint8_t in) {
  if (!selected_) {
    return 0xFF;  // nobody drives the line
  }
  if (!running_) {
    violation("SPI before the oscillator has started up");
    return 0;
  }
  const bool first = instruction_.bytes == 0;
  if (instruction_.bytes < 0xFF) {
    ++instruction_.bytes;
  }
  return first ? begin_instruction(in) : continue_instruction(in);
}

std::uint8_t Mcp2515Chip::begin_instruction(std::uint8_t code) {
  instruction_.code = code;
  if (code == reset_code) {
    start(false);
  } else if (is_read_buffer(code)) {
    const int buffer = (code >> 2) & 1;
    const bool data_only = (code & 2) != 0;
    instruction_.address = static_cast<std::uint8_t>(map::receive_control(buffer) +
                                                     (data_only ? map::data : map::sidh));
    instruction_.frees = map::rxif(buffer);
  } else if (is_load_buffer(code)) {
    const int buffer = (code & 7) >> 1;
    const bool data_only = (code & 1) != 0;
    instruction_.address = static_cast<std::uint8_t>(map::transmit_control(buffer) +
                                                     (data_only ? map::data : map::sidh));
  } else if (is_request_to_send(code)) {
    instruction_.requests = code & 7;
  } else if (code != read_code && code != write_code && code != bit_modify_code &&
             code != read_status_code && code != receive_status_code) {
    violation("SPI instruction " + std::to_string(code) + " is none");
  }
  return 0;
}

std::uint8_t Mcp2515Chip::continue_instruction(std::uint8_t in) {
  Instruction& i = instruction_;
  const bool address_byte = i.bytes == 2;
  if (i.code == read_status_code) {
    return read_status();
  }
  if (i.code == receive_status_code) {
    return receive_status();
  }
  if (is_read_buffer(i.code) || (i.code == read_code && !address_byte)) {
    const std::uint8_t out = read_register(i.address);
    i.address = after(i.address);
    return out;
  }
  if (is_load_buffer(i.code) || (i.code == write_code && !address_byte)) {
    const std::uint8_t address = i.address;
    i.address = after(i.address);
    write_register(address, in);
    return 0;
  }
  if (i.code == read_code || i.code == write_code || (i.code == bit_modify_code && address_byte)) {
    if (in >= map::register_count) {
      violation("register address " + std::to_string(in) + " is above 127");
    }
    i.address = in & (map::register_count - 1U);
  } else if (i.code == bit_modify_code && i.bytes == 3) {
    i.mask = in;
  } else if (i.code == bit_modify_code && i.bytes == 4) {
    modify_register(i.address, in, i.mask);
  }
  return 0;
}

// RX0IF | RX1IF | TXB0 TXREQ, TX0IF | TXB1 TXREQ, TX1IF | TXB2 TXREQ, TX2IF, from bit 0 (figure
// 12-8).
std::uint8_t Mcp2515Chip::read_status() const {
  unsigned status = registers_[map::canintf] & 3U;
  for (unsigned buffer = 0; buffer < 3; ++buffer) {
    const int b = static_cast<int>(buffer);
    const bool requested = (registers_.at(map::transmit_control(b)) & map::txreq) != 0;
    const bool sent = (registers_[map::canintf] & map::txif(b)) != 0;
    status |= (requested ? 4U : 0U) << (2 * buffer);
    status |= (sent ? 8U : 0U) << (2 * buffer);
  }
  return static_cast<std::uint8_t>(status);
}

// Which buffers are full | of the first of them: extended, remote, filter (figure 12-9).
std::uint8_t Mcp2515Chip::receive_status() const {
  const unsigned full = registers_[map::canintf] & 3U;
  if (full == 0) {
    return 0;
  }
  const int buffer = (full & 1U) != 0 ? 0 : 1;
  const std::uint8_t base = map::receive_control(buffer);
  const bool extended = (registers_.at(base + map::sidl) & map::ide) != 0;
  const bool remote = (registers_.at(base) & map::rxrtr) != 0;
  unsigned filter = registers_.at(base) & (buffer == 0 ? 1U : 7U);
  if (buffer == 1 && filter < 2) {
    filter += 6;  // rolled over from RXB0
  }
  return static_cast<std::uint8_t>(full << 6 | (extended ? 0x10U : 0U) | (remote ? 0x08U : 0U) |
                                   filter);
}

}  // namespace roio::sim
