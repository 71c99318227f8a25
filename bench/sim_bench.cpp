// What the simulated bus costs: every node has a frame to send at any time, so the bus is saturated
// and all of them contend for it. Prints a table; exits with 1 when a frame went missing.
//
//   sim_bench [SIMULATED_MILLISECONDS]
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <roio/frame_length.hpp>
#include <roio/sim/host_node.hpp>
#include <roio/sim/mcp2515_chip.hpp>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t bitrate_bps = 500'000;

/// 8 bytes, extended, each node its own identifier.
roio::Frame frame_of(std::uint32_t node) {
  return {0x10000000 + node, roio::FrameKind::extended, 8, {0x5A, 0x2D, 0x11, 0x80, 7, 6, 5, 4}};
}

/// A node that always has the next frame ready, and counts what it hears.
class Talker {
 public:
  Talker(roio::sim::CanBus& bus, std::uint32_t number)
      : node_(bus, bitrate_bps), frame_(frame_of(number)) {
    node_.on_sent([this](const roio::Frame& frame) { node_.send(frame); });
    node_.on_receive([this](const roio::Frame&) { ++received_; });
  }
  void start() { node_.send(frame_); }
  [[nodiscard]] std::uint64_t received() const { return received_; }

 private:
  roio::sim::HostNode node_;
  roio::Frame frame_;
  std::uint64_t received_ = 0;
};

/// A chip whose transmit buffer 0 is asked for again with every frame that it sent. Nobody reads
/// its receive buffers: two frames stay there, and the rest overflows.
class TalkingChip {
 public:
  TalkingChip(roio::sim::CanBus& bus, std::uint32_t number) : chip_(bus) {
    bus.run_for(std::chrono::milliseconds(1));  // its oscillator starts
    const roio::Frame frame = frame_of(number);
    // CNF3 to CNF1: 16 quanta a bit, sampled after 13; 500 kbit/s at 16 MHz.
    instruction({0x02, 0x28, 0x02, 0xAD, 0x00});
    instruction({0x02, 0x60, 0x64});  // receive everything, roll over
    instruction({0x02, 0x70, 0x60});
    const auto id = [&](unsigned shift) { return static_cast<std::uint8_t>(frame.id >> shift); };
    const auto sidl = static_cast<std::uint8_t>((id(13) & 0xE0U) | 0x08U | (id(16) & 0x03U));
    instruction({0x40, id(21), sidl, id(8), id(0), 8, 0x5A, 0x2D, 0x11, 0x80, 7, 6, 5, 4});
    instruction({0x02, 0x0F, 0x00});  // normal mode
    chip_.on_sent([this](const roio::Frame&) { start(); });
  }
  void start() { instruction({0x81}); }  // request to send
  [[nodiscard]] std::uint64_t received() const {
    return chip_.events().accepted + chip_.events().overflowed;
  }

 private:
  void instruction(std::initializer_list<std::uint8_t> bytes) {
    chip_.select();
    for (const std::uint8_t byte : bytes) {
      chip_.exchange(byte);
    }
    chip_.deselect();
  }

  roio::sim::Mcp2515Chip chip_;
};

template <typename Node>
bool saturated(const char* kind, std::uint32_t nodes, std::chrono::milliseconds simulated) {
  roio::sim::CanBus bus;
  std::vector<std::unique_ptr<Node>> talkers;
  for (std::uint32_t number = 0; number < nodes; ++number) {
    talkers.push_back(std::make_unique<Node>(bus, number));
  }
  // From where everybody hears everything.
  bus.run_for(std::chrono::milliseconds(1));
  for (auto& talker : talkers) {
    talker->start();
  }
  const auto start = Clock::now();
  bus.run_for(simulated);
  const double took = std::chrono::duration<double>(Clock::now() - start).count();
  const roio::sim::BusStatistics statistics = bus.statistics();
  std::uint64_t received = 0;
  for (const auto& talker : talkers) {
    received += talker->received();
  }
  const bool all_there = received == statistics.frames * (nodes - 1);
  const auto frames = static_cast<double>(statistics.frames);
  std::printf("%3u %s: %llu frames in %.3f s, %.0f frames/s, %.2f x real time, load %.3f, %s\n",
              nodes, kind, static_cast<unsigned long long>(statistics.frames), took, frames / took,
              std::chrono::duration<double>(simulated).count() / took, statistics.load(),
              all_there ? "all there" : "LOST");
  return all_there && statistics.frames > 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::chrono::milliseconds simulated(argc > 1 ? std::stol(argv[1]) : 1000);
  bool all_there = true;
  for (const std::uint32_t nodes : {2U, 20U, 200U}) {
    all_there = saturated<Talker>("host nodes", nodes, simulated) && all_there;
  }
  all_there = saturated<TalkingChip>("MCP2515s", 20, simulated) && all_there;
  return all_there ? 0 : 1;
}
