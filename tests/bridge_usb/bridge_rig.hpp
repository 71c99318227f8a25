/// A simulated board that runs the bridge's own image, a node on its bus, and a PC at its UART that
/// knows records and nothing more: each test says itself what the PC sends.
#ifndef ROIO_TESTS_BRIDGE_RIG_HPP
#define ROIO_TESTS_BRIDGE_RIG_HPP

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <roio/frame.hpp>
#include <roio/serial_protocol.hpp>
#include <roio/sim/board.hpp>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <roio/status.hpp>
#include <roio/version.hpp>
#include <string>
#include <vector>

namespace roio::test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t bitrate_bps = 500'000;
constexpr std::uint32_t session_number = 0x52AB0149;
// In COUNTERS.
constexpr int dropped_counter = 0;
constexpr int overflow_counter = 1;

inline std::filesystem::path bridge_image(sim::BoardKind kind) {
  const char* const folder = kind == sim::BoardKind::uno        ? "uno"
                             : kind == sim::BoardKind::leonardo ? "leonardo"
                                                                : "mega";
  return std::filesystem::path(ROIO_IMAGES_DIR) / folder / "bridge_usb.elf";
}

/// Written from docs/internals/serial-protocol.md: the body of a control record.
inline Bytes body_of(serial::Down operation, std::uint8_t sequence, const Bytes& payload = {}) {
  Bytes body{static_cast<std::uint8_t>(operation), sequence};
  body.insert(body.end(), payload.begin(), payload.end());
  return body;
}
inline Bytes bytes_of(std::uint32_t value) {
  return {static_cast<std::uint8_t>(value >> 24), static_cast<std::uint8_t>(value >> 16),
          static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
}
inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline Bytes record_of(const Bytes& body, std::uint32_t session) {
  struct Sink {
    void put(std::uint8_t offset, std::uint8_t byte) { bytes.at(offset) = byte; }
    std::array<std::uint8_t, serial::max_record> bytes{};
  } sink;
  serial::RecordWriter<Sink> writer(sink, session);
  for (const std::uint8_t byte : body) {
    writer.put(byte);
  }
  const std::uint8_t length = writer.finish();
  return {sink.bytes.begin(), sink.bytes.begin() + length};
}

inline Frame extended(std::uint32_t id, const Bytes& data = {}) {
  Frame frame{id, FrameKind::extended, static_cast<std::uint8_t>(data.size()), {}};
  std::copy(data.begin(), data.end(), frame.data);
  return frame;
}

struct BridgeRig {
  explicit BridgeRig(sim::BoardKind kind = sim::BoardKind::uno, sim::BoardOptions options = {})
      : node(bus, bitrate_bps), board(bus, kind, bridge_image(kind), options) {
    node.on_receive([this](const Frame& frame) { on_bus.push_back(frame); });
    board.on_serial(0, [this](std::uint8_t byte) { take(byte); });
    // The crystal is measured, the controller started, and USB set up.
    bus.run_for(kind == sim::BoardKind::leonardo ? 100ms : 20ms);
  }
  ~BridgeRig() {
    EXPECT_TRUE(board.violations().empty()) << board.violations().front().what;
    EXPECT_TRUE(board.chip().violations().empty()) << board.chip().violations().front().what;
  }
  BridgeRig(const BridgeRig&) = delete;
  BridgeRig& operator=(const BridgeRig&) = delete;

  // --- down --------------------------------------------------------------------------------------

  void write(const Bytes& bytes) { board.serial_write(0, bytes); }
  void say(serial::Down operation, const Bytes& payload = {}) {
    write(record_of(body_of(operation, next_down, payload), session));
  }
  void poll(bool counters = false) { say(serial::Down::poll, {std::uint8_t{counters}}); }
  /// The bytes of a frame's record.
  [[nodiscard]] Bytes frame_record(const Frame& frame, std::uint8_t sequence,
                                   std::uint8_t life = serial::life_forever) const {
    Bytes body = bytes_of(tagged_id(frame)) + Bytes{sequence, life};
    if (is_remote(frame.kind)) {
      body.push_back(frame.length);
    } else {
      body.insert(body.end(), frame.data, frame.data + frame.length);
    }
    return record_of(body, session);
  }
  void send(const Frame& frame, std::uint8_t life = serial::life_forever) {
    write(frame_record(frame, next_down++, life));
  }
  /// A PC that is there: it polls.
  void poll_for(sim::SimTime span) {
    for (sim::SimTime left = span; left > 0ms; left -= 50ms) {
      poll();
      bus.run_for(std::min<sim::SimTime>(left, 50ms));
    }
  }
  /// Whether anybody acknowledges what the bridge sends.
  void set_peer(bool there) {
    node.controller().set_mode(there ? sim::Controller::Mode::normal : sim::Controller::Mode::off);
  }

  /// HELLO, and what was answered.
  Bytes hello(std::uint32_t number = session_number) {
    records.clear();
    write(record_of(body_of(serial::Down::hello, 0, Bytes{2} + bytes_of(number)), 0));
    session = number;
    next_down = 0;
    bus.run_for(20ms);
    return last(serial::Up::welcome).value_or(Bytes{});
  }
  /// A request, repeated until its REPLY is there.
  std::optional<Status> request(serial::Down operation, const Bytes& payload = {}) {
    ++request_number;
    say(operation, Bytes{request_number} + payload);
    for (int i = 0; i < 300; ++i) {
      bus.run_for(1ms);
      const auto reply = last(serial::Up::reply);
      if (reply && reply->at(2) == request_number) {
        return static_cast<Status>(reply->at(3));
      }
    }
    return std::nullopt;
  }
  /// SPEED, and the trial that a PC makes of it.
  void set_line_rate(std::uint32_t rate_bps) {
    ASSERT_EQ(request(serial::Down::speed, bytes_of(rate_bps)), Status::ok);
    bus.run_for(5ms);
    ask_status();
  }
  /// Asks for it and gives the answer's payload; the session must be open.
  Bytes ask_status() {
    records.clear();
    poll(true);
    bus.run_for(20ms);
    return last(serial::Up::status).value_or(Bytes{});
  }
  std::uint32_t counter(int index) {
    ask_status();
    for (const Bytes& body : records) {
      if (body[0] == static_cast<std::uint8_t>(serial::Up::counters) && index >= body[2] &&
          index < body[2] + static_cast<int>((body.size() - 3) / 4)) {
        return serial::get32(body.data() + 3 + 4 * (index - body[2]));
      }
    }
    ADD_FAILURE() << "no counters";
    return 0;
  }

  // --- up ----------------------------------------------------------------------------------------

  [[nodiscard]] std::optional<Bytes> last(serial::Up operation) const {
    for (auto it = records.rbegin(); it != records.rend(); ++it) {
      if (it->at(0) == static_cast<std::uint8_t>(operation)) {
        return *it;
      }
    }
    return std::nullopt;
  }
  /// Frames among the records.
  [[nodiscard]] std::vector<Frame> frames() const {
    std::vector<Frame> found;
    for (const Bytes& body : records) {
      Frame frame{};
      if (!serial::is_control(body[0]) &&
          serial::read_frame(body.data(), static_cast<std::uint8_t>(body.size()),
                             serial::frame_head_up, frame)) {
        found.push_back(frame);
      }
    }
    return found;
  }

  sim::CanBus bus;
  sim::HostNode node;
  sim::Board board;
  std::vector<Frame> on_bus;
  std::vector<Bytes> records;  // bodies
  Bytes text;                  // all bytes
  int damaged = 0;
  std::uint32_t session = 0;
  std::uint8_t next_down = 0;
  std::uint8_t request_number = 0;

 private:
  void take(std::uint8_t byte) {
    text.push_back(byte);
    switch (reader_.take(byte)) {
      case serial::RecordReader::Event::none:
        return;
      case serial::RecordReader::Event::record:
        if (reader_.is_intact(serial::session_of(reader_.body()[0], session))) {
          records.emplace_back(reader_.body(), reader_.body() + reader_.length());
          return;
        }
        break;
      case serial::RecordReader::Event::damaged:
        break;
    }
    ++damaged;
  }

  serial::RecordReader reader_;
};

}  // namespace roio::test

#endif
