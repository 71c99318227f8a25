/// A board that runs a shipped sketch, a PC on the same bus, and what both have got.
#ifndef ROIO_TESTS_EXAMPLES_RUN_SKETCH_RIG_HPP
#define ROIO_TESTS_EXAMPLES_RUN_SKETCH_RIG_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <roio/frame.hpp>
#include <roio/message.hpp>
#include <roio/sim/board.hpp>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <string>
#include <vector>

namespace roio::test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Texts = std::vector<std::string>;

constexpr Address pc_address{0, 10};
constexpr std::uint32_t bitrate_bps = 500'000;

inline std::filesystem::path image(sim::BoardKind kind, const std::string& sketch) {
  const char* folder = kind == sim::BoardKind::uno    ? "uno"
                       : kind == sim::BoardKind::mega ? "mega"
                                                      : "leonardo";
  return std::filesystem::path(ROIO_IMAGES_DIR) / folder / (sketch + ".elf");
}

inline std::string text(Address address) {
  return std::to_string(address.subnet) + '.' +
         (is_broadcast(address) ? "*" : std::to_string(address.node));
}

/// "0.2 > 0.10 urgent: 5A 2D"; normal priority is not told.
inline std::string text(const Frame& frame) {
  Message message{};
  if (to_message(frame, message) != Status::ok) {
    return "not a message";
  }
  constexpr const char* digits = "0123456789ABCDEF";
  std::string result = text(message.header.source) + " > " + text(message.header.destination);
  result += message.header.priority == Priority::urgent ? " urgent:" : ":";
  for (int i = 0; i < message.length; ++i) {
    result += ' ';
    result += digits[message.data[i] >> 4];
    result += digits[message.data[i] & 15];
  }
  return result;
}

inline Frame frame_of(Address source, Address destination, const Bytes& data,
                      Priority priority = Priority::normal) {
  Message message{{priority, MessageClass::message, destination, source},
                  static_cast<std::uint8_t>(data.size()),
                  {}};
  std::copy(data.begin(), data.end(), message.data);
  Frame frame{};
  EXPECT_EQ(to_frame(message, frame), Status::ok);
  return frame;
}

/// The crystal of the module is 16 MHz, and all that a sketch leaves out is as its wiring table
/// says.
struct SketchRig {
  SketchRig(sim::BoardKind kind, const std::string& sketch, const sim::BoardOptions& options = {})
      : pc(bus, bitrate_bps), board(bus, kind, image(kind, sketch), options) {
    pc.on_receive([this](const Frame& frame) {
      received.push_back(text(frame));
      received_at.push_back(bus.now());
    });
    if (kind != sim::BoardKind::leonardo) {
      board.on_serial(0, [this](std::uint8_t byte) { take(byte); });
    }
  }
  ~SketchRig() { EXPECT_TRUE(board.violations().empty()) << board.violations().front().what; }
  SketchRig(const SketchRig&) = delete;
  SketchRig& operator=(const SketchRig&) = delete;

  void send(Address destination, const Bytes& data, Priority priority = Priority::normal) {
    pc.send(frame_of(pc_address, destination, data, priority));
  }
  /// Runs for a while and gives the messages that the PC got meanwhile.
  Texts run(sim::SimTime span) {
    received.clear();
    received_at.clear();
    bus.run_for(span);
    return received;
  }
  /// Runs for a while and gives the whole lines that were printed meanwhile.
  Texts run_for_lines(sim::SimTime span) {
    lines.clear();
    bus.run_for(span);
    return lines;
  }

  sim::CanBus bus;
  sim::HostNode pc;
  sim::Board board;
  Texts received;
  std::vector<sim::SimTime> received_at;
  Texts lines;

 private:
  void take(std::uint8_t byte) {
    if (byte == '\n') {
      lines.push_back(line_);
      line_.clear();
    } else if (byte != '\r') {
      line_ += static_cast<char>(byte);
    }
  }

  std::string line_;
};

class EachBoard : public testing::TestWithParam<sim::BoardKind> {};

inline const auto all_boards =
    testing::Values(sim::BoardKind::uno, sim::BoardKind::leonardo, sim::BoardKind::mega);
inline std::string board_name(const testing::TestParamInfo<sim::BoardKind>& kind) {
  return sim::to_string(kind.param);
}

}  // namespace roio::test

#endif
