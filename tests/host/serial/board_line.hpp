/// A serial session and the bridge's own image on a simulated board, in simulated time.
#ifndef ROIO_TESTS_SERIAL_BOARD_LINE_HPP
#define ROIO_TESTS_SERIAL_BOARD_LINE_HPP

#include <algorithm>
#include <cmath>
#include <roio/sim/board.hpp>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>

#include "line.hpp"

namespace roio::test {

/// The PC looks at its port so often; a byte of the board is heard when it comes.
inline constexpr Time look_interval = 50us;

inline Time to_time(sim::SimTime time) {
  return std::chrono::duration_cast<Time>(time);
}

class BoardLine {
 public:
  explicit BoardLine(SerialSettings settings = {}, std::uint32_t bitrate_bps = 500'000)
      : node(bus, bitrate_bps),
        board(bus, sim::BoardKind::uno, ROIO_IMAGES_DIR "/uno/bridge_usb.elf"),
        session(std::move(settings), [this] { return ++nonce_; }) {
    node.on_receive([this](const Frame& frame) { on_bus.push_back(frame); });
    board.on_serial(0, [this](std::uint8_t byte) { hear(byte); });
  }

  /// Each: what becomes of a byte.
  std::function<std::optional<std::uint8_t>(std::uint8_t)> down_fault;
  std::function<std::optional<std::uint8_t>(std::uint8_t)> up_fault;
  /// Called when the PC looks.
  std::function<void()> at_each_look;

  [[nodiscard]] Time now() const { return to_time(bus.now()); }

  void run_for(Time span) {
    run_until([] { return false; }, span);
  }
  bool run_until(const std::function<bool()>& it_is_so, Time patience) {
    for (const Time end = now() + patience; now() < end && !it_is_so();) {
      bus.run_for(look_interval);
      session.on_time(now());
      if (at_each_look) {
        at_each_look();
      }
      write();
      for (const auto& one : session.take_arrived()) {
        arrived.push_back(one);
      }
    }
    return it_is_so();
  }
  [[nodiscard]] bool is_ready() const { return session.phase() == Phase::ready; }
  void open() {
    session.begin(now());
    ASSERT_TRUE(run_until([this] { return is_ready(); }, 3s));
    run_for(200ms);
  }
  /// Of the bridge, asked now.
  BridgeCounters counters() {
    const std::uint64_t before = session.counter_reports();
    session.ask_counters(now());
    EXPECT_TRUE(run_until([&] { return session.counter_reports() > before; }, 1s));
    return session.bridge_counters();
  }

  sim::CanBus bus;
  sim::HostNode node;
  sim::Board board;
  SerialSession session;
  std::vector<SerialSession::Arrived> arrived;
  std::vector<Frame> on_bus;  // that the bridge has sent

 private:
  [[nodiscard]] bool rates_match() const {
    const double rate_bps = session.line_rate_bps();
    return std::abs(board.serial_bitrate_bps(0).value() - rate_bps) < 0.045 * rate_bps;
  }
  void hear(std::uint8_t byte) {
    std::optional<std::uint8_t> heard = byte;
    if (!rates_match()) {
      heard = static_cast<std::uint8_t>(garbage_());
    }
    if (heard && up_fault) {
      heard = up_fault(*heard);
    }
    if (heard) {
      session.receive(std::span(&*heard, 1), now());
    }
  }
  void write() {
    Bytes bytes;
    for (std::uint8_t byte : session.output()) {
      if (!rates_match()) {
        byte = static_cast<std::uint8_t>(garbage_());
      }
      if (const auto sent = down_fault ? down_fault(byte) : std::optional(byte)) {
        bytes.push_back(*sent);
      }
    }
    session.consume_output(session.output().size());
    board.serial_write(0, bytes);
  }

  std::uint32_t nonce_ = 0x3000;
  std::mt19937 garbage_{11};
};

/// A normal identifier with a number of 16 bits in it. Of two senders each wins arbitration as
/// often as the other: what is above the number changes from frame to frame.
inline std::uint32_t numbered_id(std::uint32_t number, std::uint32_t sender) {
  const std::uint32_t hash = (2 * number + sender) * 2654435761U >> 25;
  return 0x10000000 | hash << 21 | (number & 0xFFFF) << 5 | sender;
}
inline std::uint32_t number_of_id(std::uint32_t id) {
  return (id >> 5) & 0xFFFFU;
}

/// What a node of the bus sends without a pause: frames of 0..8 bytes, each with its number.
class Flood {
 public:
  explicit Flood(BoardLine& line) : line_(line) {
    line_.node.on_sent([this](const Frame& /*frame*/) { give(); });
    give();
    give();
  }
  /// Those under way still go out.
  void stop() { line_.node.on_sent(nullptr); }
  [[nodiscard]] std::uint32_t sent() const { return next_; }

 private:
  void give() {
    Frame frame{
        numbered_id(next_, 0), FrameKind::extended, static_cast<std::uint8_t>(next_ % 9), {}};
    std::fill_n(frame.data, 8, std::uint8_t{0x55});  // few bits are stuffed
    line_.node.send(frame);
    ++next_;
  }
  BoardLine& line_;
  std::uint32_t next_ = 0;
};

inline void expect_arrived_in_order(const BoardLine& line) {
  std::uint32_t next = 0;
  for (const auto& one : line.arrived) {
    ASSERT_GE(number_of_id(one.frame.id), next) << "out of order, or twice";
    next = number_of_id(one.frame.id) + 1;
  }
}

/// In order, none twice, and what is missing is counted; of what the controller itself lost, only
/// how many times.
inline void expect_all_told(BoardLine& line, std::uint32_t sent) {
  ASSERT_NO_FATAL_FAILURE(expect_arrived_in_order(line));
  const std::uint32_t overflows = line.counters().overflows;
  const std::uint64_t told = line.arrived.size() + line.session.lost();
  EXPECT_LE(told, sent);
  EXPECT_EQ(told == sent, overflows == 0) << sent - told << " in " << overflows << " overflows";
}

/// Keeps the session's lanes full of frames of 0..8 bytes.
class Source {
 public:
  explicit Source(BoardLine& line) : line_(line) {}
  void fill() {
    while (line_.session.waiting() < 16) {
      Frame frame{
          numbered_id(offered, 1), FrameKind::extended, static_cast<std::uint8_t>(offered % 9), {}};
      std::fill_n(frame.data, 8, std::uint8_t{0x55});
      if (line_.session.offer(std::span(&frame, 1), line_.now()) == 0) {
        return;
      }
      ++offered;
    }
  }
  std::uint32_t offered = 0;

 private:
  BoardLine& line_;
};

inline void expect_on_bus_in_order(const BoardLine& line) {
  std::uint32_t next = 0;
  for (const Frame& frame : line.on_bus) {
    ASSERT_GE(number_of_id(frame.id), next) << "out of order, or twice";
    next = number_of_id(frame.id) + 1;
  }
}

}  // namespace roio::test

#endif
