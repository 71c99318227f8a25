/// ScriptedBridge: the bridge's side of docs/internals/serial-protocol.md, written from that text
/// and from nothing else: no firmware, no controller; a test says what is on its bus, and may break
/// any rule.
#ifndef ROIO_TESTS_SERIAL_SCRIPTED_BRIDGE_HPP
#define ROIO_TESTS_SERIAL_SCRIPTED_BRIDGE_HPP

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <roio/frame.hpp>
#include <roio/serial_protocol.hpp>
#include <string>
#include <vector>

namespace roio::test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Time = std::chrono::nanoseconds;

inline void append32(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A record's bytes on the line.
Bytes record_of(const Bytes& body, std::uint32_t session);

class ScriptedBridge {
 public:
  // What it is; to be set before it answers.
  std::uint8_t version = serial::protocol_version;
  std::uint8_t flags = serial::rate_matters | serial::interrupt_is_wired;
  std::uint8_t rates = 0x1F;
  std::uint8_t window = serial::window;
  std::uint16_t osc_khz = 16'000;
  std::uint32_t bitrate_bps = 500'000;
  std::uint8_t mode = 0;
  std::array<std::uint8_t, 2> address{0, 254};
  std::uint8_t state = 0;
  /// Of the bridge's clock from the simulation's, and how much faster it is.
  std::uint32_t first_tick = 0;
  double clock_speed = 1;

  // What it does.
  /// Whether frames from the PC are sent at once; else they wait for finish().
  bool bus_is_free = true;
  /// Whether it answers requests, by their operation; without it: ok.
  std::function<std::optional<std::uint8_t>(serial::Down)> verdict;
  /// Answers nothing at all.
  bool is_deaf = false;
  /// Called with each body before it is sent; false: it is not.
  std::function<bool(const Bytes&)> may_send;
  /// Called with the body of each frame that comes next; false: it is not taken.
  std::function<bool(const Bytes&)> may_take;

  // What it has seen.
  struct Rule {
    std::uint32_t match;
    std::uint32_t mask;
  };
  std::vector<Rule> rules{{0, 0}};
  std::vector<Frame> on_bus;         // in the order in which they were taken
  std::vector<Bytes> heard;          // bodies of control records, intact ones
  std::vector<Bytes> frame_records;  // and of frames, those that come again, too
  int hellos = 0;
  int damaged = 0;
  int unheard = 0;  // records that came while it was deaf
  std::uint32_t due = 0;
  std::uint32_t rate_bps = serial::base_rate_bps;

  [[nodiscard]] std::uint32_t session() const { return session_; }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] int count_of(serial::Down operation) const;

  /// What is to go to the PC: bytes that were sent at `rate` each.
  struct Sent {
    std::uint8_t byte;
    std::uint32_t rate_bps;
  };
  std::deque<Sent> out;

  void take(std::uint8_t byte, Time now);
  void on_time(Time now);
  /// A frame comes in from the bus; `has_room` false: it is due, and dropped.
  void hear(const Frame& frame, Time now, bool has_room = true);
  /// So many frames that wait come to their end.
  void finish(std::size_t count, serial::Outcome outcome = serial::Outcome::sent);
  /// The reset button.
  void reset();
  /// Sends a control record of this session.
  void send(serial::Up operation, const Bytes& payload);
  void send_body(const Bytes& body, std::uint32_t session);
  void send_results(bool again);
  void send_status(Time now);

 private:
  void hello(const std::uint8_t* body, std::uint8_t length);
  void control(const Bytes& body, Time now);
  void take_frame(const Bytes& body);
  void notice(std::uint8_t sequence);
  void put_outcome(std::uint8_t sequence, serial::Outcome outcome);
  void end_session();
  [[nodiscard]] std::uint32_t ticks(Time now) const;

  struct Waiting {
    std::uint8_t sequence;
    Frame frame;
  };

  serial::RecordReader reader_;
  std::uint32_t session_ = 0;
  std::uint32_t welcomed_ = 0;
  std::uint32_t previous_ = 0;
  std::uint32_t previous_due_ = 0;
  std::uint8_t next_ = 0;
  bool gap_told_ = false;
  std::uint32_t slots_ = 0;
  std::deque<Waiting> waiting_;
  Time heard_at_{0};
  bool on_trial_ = false;
  Bytes held_;
};

}  // namespace roio::test

#endif
