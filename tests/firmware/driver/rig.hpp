/// One simulated chip with the driver on it, a peer on the same bus, and what they did.
#ifndef ROIO_TESTS_DRIVER_RIG_HPP
#define ROIO_TESTS_DRIVER_RIG_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <roio/mcp2515.hpp>
#include <roio/sim/host_node.hpp>
#include <roio/sim/spi_wire.hpp>
#include <utility>
#include <vector>

namespace roio {

inline bool operator==(const Frame& a, const Frame& b) {
  return a.kind == b.kind && a.id == b.id && a.length == b.length &&
         (is_remote(a.kind) || std::equal(a.data, a.data + std::min<int>(a.length, 8), b.data));
}

inline std::ostream& operator<<(std::ostream& out, const Frame& frame) {
  out << std::hex << frame.id << std::dec << '#' << int{frame.length};
  for (int i = 0; i < std::min<int>(frame.length, 8); ++i) {
    out << ' ' << int{frame.data[i]};
  }
  return out;
}

inline std::ostream& operator<<(std::ostream& out, TxOutcome outcome) {
  constexpr std::array<const char*, 4> names{"sent", "failed", "aborted", "unknown"};
  return out << names.at(static_cast<std::size_t>(outcome));
}

}  // namespace roio

namespace roio::test {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Address own{0, 2};
constexpr std::uint32_t to_own = 0x10004000;  // normal, class message, to 0.2, from 0.0
constexpr std::uint32_t urgent_to_own = 0x00004000;
constexpr std::uint32_t to_everybody = 0x101FE000;  // normal, to 0.*

/// A frame that carries a number in as many bytes as it has.
inline Frame numbered(std::uint32_t number, std::uint8_t length = 4, std::uint32_t id = to_own) {
  Frame frame{id, FrameKind::extended, length, {}};
  for (unsigned i = 0; i < std::min<unsigned>(length, 4); ++i) {
    frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i));
  }
  return frame;
}

inline std::uint32_t number_of(const Frame& frame) {
  std::uint32_t number = 0;
  for (unsigned i = 0; i < std::min<unsigned>(frame.length, 4); ++i) {
    number |= std::uint32_t{frame.data[i]} << (8 * i);
  }
  return number;
}

struct Outcome {
  std::uint8_t token;
  TxOutcome outcome;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};
inline std::ostream& operator<<(std::ostream& out, const Outcome& outcome) {
  return out << int{outcome.token} << ' ' << outcome.outcome;
}

/// Everything switched on, and outcomes kept.
struct TestTraits : Mcp2515Traits {
  using Count = std::uint64_t;
  static constexpr bool reports_outcomes = true;
  void on_outcome(std::uint8_t token, TxOutcome outcome) { outcomes.push_back({token, outcome}); }
  std::vector<Outcome> outcomes;
};

struct BackToBack : TestTraits {
  static constexpr bool back_to_back = true;
};

template <std::uint32_t BitrateBps = 500'000>
inline Mcp2515Config plain_config(mcp2515::Mode mode = mcp2515::Mode::normal,
                                  bool one_shot = false) {
  return {bit_timing<16'000'000, BitrateBps>(), mcp2515_filters_of(own), mode, one_shot};
}
constexpr BitTiming plain_timing = bit_timing<16'000'000, 500'000>();

struct RigOptions {
  std::uint32_t bitrate_bps = 500'000;
  sim::Mcp2515Options chip{};
  sim::SpiWire::Timing spi{};
};

/// The chip has been on for a millisecond, the driver has not begun.
template <bool WithLine = false, std::uint8_t RxQueue = 0, std::uint8_t TxQueue = 0,
          typename Traits = TestTraits>
struct Rig {
  explicit Rig(const RigOptions& options = {})
      : peer(bus, options.bitrate_bps), chip(bus, options.chip), wire(bus, chip, options.spi) {
    bus.run_for(milliseconds(1));
    chip.on_accepted([this](const Frame& frame) { accepted.push_back(frame); });
    peer.on_receive([this](const Frame& frame) { peer_received.push_back(frame); });
  }

  /// Begins, as most tests do; what that took is not counted.
  void begin(const Mcp2515Config& config = plain_config()) {
    ASSERT_EQ(can.begin(config), Status::ok);
    ASSERT_TRUE(chip.violations().empty()) << chip.violations().front().what;
    mark();
  }

  void mark() {
    bytes_marked_ = wire.bytes();
    transactions_marked_ = wire.transactions();
  }
  /// SPI bytes and transactions since mark().
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> spent() const {
    return {wire.bytes() - bytes_marked_, wire.transactions() - transactions_marked_};
  }

  /// What receive() hands out until it has nothing.
  std::vector<Frame> receive_all() {
    std::vector<Frame> frames;
    Frame frame{};
    while (can.receive(frame) == Status::ok) {
      frames.push_back(frame);
    }
    return frames;
  }

  /// The peer sends these, and the bus carries them.
  void peer_sends(const std::vector<Frame>& frames) {
    for (const Frame& frame : frames) {
      peer.send(frame);
    }
    bus.run_for(milliseconds(1) * static_cast<int>(frames.size()));
    ASSERT_EQ(peer.waiting(), 0U);
  }

  sim::CanBus bus;
  sim::HostNode peer;
  sim::Mcp2515Chip chip;
  sim::SpiWire wire;
  Mcp2515<sim::ChipPort<WithLine>, RxQueue, TxQueue, Traits> can{wire};
  std::vector<Frame> accepted;       // by the chip, in its order
  std::vector<Frame> peer_received;  // what the driver has sent

 private:
  std::uint64_t bytes_marked_ = 0;
  std::uint64_t transactions_marked_ = 0;
};

/// A frame each way.
template <typename AnyRig>
void expect_it_works(AnyRig& rig) {
  rig.peer_received.clear();
  rig.peer_sends(
      {numbered(7), {0x10002001, FrameKind::extended, 0, {}}, numbered(8, 3, to_everybody)});
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered(7), numbered(8, 3, to_everybody)}))
      << "what is for the node, and nothing else";
  ASSERT_EQ(rig.can.send(numbered(9)), Status::ok);
  rig.bus.run_for(milliseconds(2));
  EXPECT_EQ(rig.peer_received, std::vector{numbered(9)});
}

}  // namespace roio::test

#endif
