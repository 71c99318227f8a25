/// One simulated MCP2515 and a peer on a bus of 500 kbit/s, with instructions as the datasheet
/// writes them: numbers in hexadecimal, and none taken from the chip's own source or from a driver.
#ifndef ROIO_TESTS_CHIP_RIG_HPP
#define ROIO_TESTS_CHIP_RIG_HPP

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <roio/sim/mcp2515_chip.hpp>
#include <string>
#include <vector>

#include "wire_text.hpp"

namespace roio::test {

using Bytes = std::vector<std::uint8_t>;

/// Most read-outs are one register; int, so that a failing test shows a number.
struct ChipRig {
  static constexpr std::uint32_t rate = 500'000;

  /// On for a millisecond: the chip waits in configuration mode.
  explicit ChipRig(const sim::Mcp2515Options& options = {}) : chip(bus, options) {
    peer.on_receive([this](const Frame& frame) { on_bus.push_back(text_of(frame)); });
    bus.run_for(std::chrono::milliseconds(1));
  }

  static constexpr sim::SimTime bits(std::int64_t count) { return sim::cycles(count, rate); }
  void run_bits(std::int64_t count) { bus.run_for(bits(count)); }

  // --- instructions (12) -------------------------------------------------------------------------

  /// What the chip shifts out while these bytes go in, between two edges of chip select.
  Bytes spi(const Bytes& in) {
    chip.select();
    Bytes out;
    for (const std::uint8_t byte : in) {
      out.push_back(chip.exchange(byte));
    }
    chip.deselect();
    return out;
  }
  int read(std::uint8_t address) { return spi({0x03, address, 0x00}).back(); }
  Bytes read(std::uint8_t address, std::size_t count) {
    Bytes in(2 + count);
    in[0] = 0x03;
    in[1] = address;
    const Bytes out = spi(in);
    return {out.begin() + 2, out.end()};
  }
  void write(std::uint8_t address, const Bytes& values) {
    Bytes in{0x02, address};
    in.insert(in.end(), values.begin(), values.end());
    spi(in);
  }
  void write(std::uint8_t address, std::uint8_t value) { write(address, Bytes{value}); }
  void modify(std::uint8_t address, std::uint8_t mask, std::uint8_t value) {
    spi({0x05, address, mask, value});
  }
  int read_status() { return spi({0xA0, 0x00}).back(); }
  int receive_status() { return spi({0xB0, 0x00}).back(); }
  /// SIDH, SIDL, EID8, EID0, DLC, D0...
  void load(int buffer, const Bytes& values) {
    Bytes in{static_cast<std::uint8_t>(0x40 + 2 * buffer)};
    in.insert(in.end(), values.begin(), values.end());
    spi(in);
  }
  void request_to_send(std::uint8_t buffers) { spi({static_cast<std::uint8_t>(0x80 | buffers)}); }

  // --- set-ups -----------------------------------------------------------------------------------

  /// 500 kbit/s from 16 MHz: 16 quanta of 125 ns, SJW 1, PropSeg 5, PS1 7, PS2 3.
  void set_bit_timing() { write(0x28, Bytes{0x02, 0xB4, 0x00}); }
  /// Bit timing and a mode; both receive buffers take any message unless told otherwise.
  void go(std::uint8_t canctrl = 0x00, std::uint8_t rxb0ctrl = 0x60, std::uint8_t rxb1ctrl = 0x60) {
    set_bit_timing();
    write(0x60, rxb0ctrl);
    write(0x70, rxb1ctrl);
    write(0x0F, canctrl);
    run_bits(12);
    ASSERT_EQ(read(0x0E) & 0xE0, canctrl & 0xE0);
  }
  /// A standard frame of one data byte in a transmit buffer: 55 bits and a few stuff bits.
  void load_standard(int buffer, std::uint32_t id, std::uint8_t byte = 0x5A) {
    load(buffer, {static_cast<std::uint8_t>(id >> 3), static_cast<std::uint8_t>((id & 7) << 5),
                  0x00, 0x00, 0x01, byte});
  }
  /// The peer no longer acknowledges.
  void silence_peer() { peer.controller().set_mode(sim::Controller::Mode::off); }
  void wake_peer() {
    peer.controller().set_mode(sim::Controller::Mode::normal);
    run_bits(12);
  }
  void peer_sends(const Frame& frame) {
    peer.send(frame);
    run_bits(200);
    ASSERT_EQ(peer.waiting(), 0U);
  }

  [[nodiscard]] std::vector<std::string> violations() const {
    std::vector<std::string> texts;
    for (const sim::Mcp2515Violation& violation : chip.violations()) {
      texts.push_back(violation.what);
    }
    return texts;
  }

  sim::CanBus bus;
  sim::HostNode peer{bus, rate};
  sim::Mcp2515Chip chip;
  std::vector<std::string> on_bus;  // what the peer has heard
};

using Texts = std::vector<std::string>;

}  // namespace roio::test

#endif
