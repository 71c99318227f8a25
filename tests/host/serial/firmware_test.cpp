// The session and the bridge's own image on a simulated board, in simulated time.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <roio/sim/board.hpp>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>

#include "line.hpp"

namespace roio::test {
namespace {

/// The PC looks at its port so often; a byte of the board is heard when it comes.
constexpr Time look_interval = 50us;

Time to_time(sim::SimTime time) {
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
std::uint32_t numbered_id(std::uint32_t number, std::uint32_t sender) {
  const std::uint32_t hash = (2 * number + sender) * 2654435761U >> 25;
  return 0x10000000 | hash << 21 | (number & 0xFFFF) << 5 | sender;
}
std::uint32_t number_of_id(std::uint32_t id) {
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

void expect_arrived_in_order(const BoardLine& line) {
  std::uint32_t next = 0;
  for (const auto& one : line.arrived) {
    ASSERT_GE(number_of_id(one.frame.id), next) << "out of order, or twice";
    next = number_of_id(one.frame.id) + 1;
  }
}

/// In order, none twice, and what is missing is counted; of what the controller itself lost, only
/// how many times.
void expect_all_told(BoardLine& line, std::uint32_t sent) {
  ASSERT_NO_FATAL_FAILURE(expect_arrived_in_order(line));
  const std::uint32_t overflows = line.counters().overflows;
  const std::uint64_t told = line.arrived.size() + line.session.lost();
  EXPECT_LE(told, sent);
  EXPECT_EQ(told == sent, overflows == 0) << sent - told << " in " << overflows << " overflows";
}

TEST(SerialFirmware, OpensAtEveryRate) {
  for (std::uint8_t i = 0; i < serial::rate_count; ++i) {
    BoardLine line({.line_rate_bps = serial::rate_bps(i)});
    line.open();
    EXPECT_EQ(line.session.line_rate_bps(), serial::rate_bps(i));
    EXPECT_EQ(line.session.counters().failed_trials, 0U);
    EXPECT_EQ(line.session.counters().damaged, 0U);
    EXPECT_EQ(line.session.info().board, BridgeBoard::uno);
    EXPECT_EQ(line.session.info().osc_khz, 16'000);
    EXPECT_EQ(line.session.info().state, BridgeState::active);
    EXPECT_TRUE(line.session.info().interrupt_wired);
  }
}

TEST(SerialFirmware, OpensOnABusThatIsFull) {
  BoardLine line;
  Flood flood(line);
  line.session.begin(line.now());
  EXPECT_TRUE(line.run_until([&] { return line.is_ready(); }, 2s));
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
}

TEST(SerialFirmware, LosesNothingOfAFullBusOf500kAt1M) {
  BoardLine line;
  line.open();
  Flood flood(line);
  line.run_for(2s);
  flood.stop();
  line.run_for(200ms);
  expect_all_told(line, flood.sent());
  EXPECT_EQ(line.session.lost(), 0U);
  EXPECT_GT(flood.sent(), 5000U);
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

void expect_on_bus_in_order(const BoardLine& line) {
  std::uint32_t next = 0;
  for (const Frame& frame : line.on_bus) {
    ASSERT_GE(number_of_id(frame.id), next) << "out of order, or twice";
    next = number_of_id(frame.id) + 1;
  }
}

TEST(SerialFirmware, FillsABusOf500kAt1M) {
  BoardLine line;
  line.open();
  Source source(line);
  const sim::BusStatistics before = line.bus.statistics();
  const Time start = line.now();
  line.at_each_look = [&] { source.fill(); };
  line.run_for(1s);
  const double load = std::chrono::duration<double>(line.bus.statistics().busy - before.busy) /
                      std::chrono::duration<double>(line.now() - start);
  line.at_each_look = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 1s));
  expect_on_bus_in_order(line);
  EXPECT_EQ(line.on_bus.size(), source.offered);
  EXPECT_EQ(line.session.down().sent, source.offered);
  EXPECT_EQ(line.session.down().resent, 0U);
  std::cout << "load of the bus: " << load << '\n';
  EXPECT_GT(load, 0.7) << "more than the processor can do (bench/figures.md)";
}

TEST(SerialFirmware, BothWaysAtOnceNothingIsLost) {
  BoardLine line;
  line.open();
  Flood flood(line);
  Source source(line);
  line.at_each_look = [&] { source.fill(); };
  line.run_for(2s);
  flood.stop();
  line.at_each_look = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 2s));
  line.run_for(200ms);
  expect_all_told(line, flood.sent());
  EXPECT_EQ(line.session.lost(), 0U);
  expect_on_bus_in_order(line);
  EXPECT_EQ(line.on_bus.size(), source.offered);
  EXPECT_EQ(line.session.down().sent, source.offered);
  EXPECT_EQ(line.session.down().resent, 0U);
  std::cout << "up " << flood.sent() << ", down " << source.offered << '\n';
}

TEST(SerialFirmware, WhatDoesNotFitIsCountedExactly) {
  BoardLine line({.line_rate_bps = 250'000});
  line.open();
  Flood flood(line);
  line.run_for(2s);
  flood.stop();
  line.run_for(300ms);
  expect_all_told(line, flood.sent());
  EXPECT_GT(line.session.lost(), 1000U);
  EXPECT_EQ(line.counters().dropped, line.session.lost());
  EXPECT_EQ(line.session.counters().sessions, 1U);
}

/// As a fault: no byte arrives.
std::optional<std::uint8_t> nothing(std::uint8_t /*byte*/) {
  return std::nullopt;
}

/// Frames both ways, as many as 115,200 bit/s carries, while something happens to the line.
class Traffic {
 public:
  explicit Traffic(BoardLine& line) : line_(line), source_(line) {
    line.at_each_look = [this, next = line.now()]() mutable {
      source_.fill();
      if (line_.now() >= next) {
        next += 4ms;
        line_.node.send({numbered_id(given_++, 0), FrameKind::extended, 0, {}});
      }
    };
  }
  void stop() {
    line_.at_each_look = nullptr;
    ASSERT_TRUE(line_.run_until([&] { return line_.session.all_done(); }, 2s));
    line_.run_for(200ms);
  }
  /// Each at most once, in order, and told truly.
  void expect_truth() const {
    ASSERT_NO_FATAL_FAILURE(expect_arrived_in_order(line_));
    expect_on_bus_in_order(line_);
    const serial::DownFrames::Counters& down = line_.session.down();
    EXPECT_EQ(down.sent + down.unknown, source_.offered);
    EXPECT_GE(line_.on_bus.size(), down.sent);
    EXPECT_LE(line_.on_bus.size(), down.sent + down.unknown);
  }
  [[nodiscard]] std::uint32_t given() const { return given_; }

 private:
  BoardLine& line_;
  Source source_;
  std::uint32_t given_ = 0;
};

TEST(SerialFirmware, AResetInTheMiddleOfARecordIsOverWithinASecond) {
  BoardLine line;
  line.open();
  Traffic traffic(line);
  line.run_for(300ms);
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t sessions = line.session.counters().sessions;
    line.board.reset();
    ASSERT_TRUE(line.run_until(
        [&] { return line.session.counters().sessions > sessions && line.is_ready(); }, 1s));
    line.run_for(200ms);
  }
  traffic.stop();
  traffic.expect_truth();
  EXPECT_LE(line.session.down().unknown, 3 * serial::window);
}

TEST(SerialFirmware, AnUnpluggedLineIsBackWithinASecond) {
  BoardLine line;
  line.open();
  Traffic traffic(line);
  line.run_for(300ms);
  // For less than the bridge's patience with a silent PC, and for more.
  for (const Time away : {Time(50ms), Time(3s)}) {
    line.up_fault = line.down_fault = nothing;
    line.session.end();
    line.run_for(away);
    line.up_fault = line.down_fault = nullptr;
    line.session.begin(line.now());
    ASSERT_TRUE(line.run_until([&] { return line.is_ready(); }, 1s)) << away.count();
    line.run_for(300ms);
  }
  traffic.stop();
  traffic.expect_truth();
  EXPECT_EQ(line.arrived.size() + line.session.lost(), traffic.given());
}

TEST(SerialFirmware, CreditThatDoesNotComeIsMadeUpForWithinASecond) {
  BoardLine line;
  line.open();
  Traffic traffic(line);
  line.run_for(300ms);
  for (int i = 0; i < 6; ++i) {
    (i % 2 == 0 ? line.up_fault : line.down_fault) = nothing;
    line.run_for(150ms);  // the window is long full
    line.up_fault = line.down_fault = nullptr;
    const std::size_t on_bus = line.on_bus.size();
    ASSERT_TRUE(line.run_until([&] { return line.on_bus.size() > on_bus + 20; }, 1s)) << i;
  }
  traffic.stop();
  traffic.expect_truth();
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.down().unknown, 0U);
  EXPECT_GT(line.session.down().resent, 0U);
  EXPECT_EQ(line.arrived.size() + line.session.lost(), traffic.given());
}

/// Changes, loses and makes up bytes.
auto faults(std::uint32_t seed, double probability) {
  return [random = std::mt19937(seed), probability](std::uint8_t byte) mutable {
    if (std::uniform_real_distribution<>(0, 1)(random) >= probability) {
      return std::optional(byte);
    }
    return random() % 2 == 0 ? std::nullopt : std::optional(static_cast<std::uint8_t>(random()));
  };
}

TEST(SerialFirmware, ALineWithErrorsLosesNothingUncounted) {
  for (const double probability : {1e-4, 1e-3}) {
    SCOPED_TRACE(probability);
    BoardLine line;
    line.open();
    line.up_fault = faults(1, probability);
    line.down_fault = faults(2, probability);
    Flood flood(line);
    Source source(line);
    line.at_each_look = [&] { source.fill(); };
    line.run_for(3s);
    flood.stop();
    line.at_each_look = nullptr;
    line.up_fault = nullptr;
    line.down_fault = nullptr;
    ASSERT_TRUE(line.run_until([&] { return line.is_ready() && line.session.all_done(); }, 5s));
    line.run_for(300ms);
    expect_all_told(line, flood.sent());
    expect_on_bus_in_order(line);
    const serial::DownFrames::Counters& down = line.session.down();
    EXPECT_EQ(down.sent + down.unknown, source.offered);
    EXPECT_GE(line.on_bus.size(), down.sent);
    EXPECT_LE(line.on_bus.size(), down.sent + down.unknown);
    std::cout << probability << ": damaged " << line.session.counters().damaged << ", lost "
              << line.session.lost() << " of " << flood.sent() << ", resent " << down.resent
              << ", unknown " << down.unknown << " of " << source.offered << ", sessions "
              << line.session.counters().sessions << ", rate " << line.session.line_rate_bps()
              << ", overflows " << line.session.bridge_counters().overflows << '\n';
  }
}

TEST(SerialFirmware, TimesAreWhenTheFramesWereOnTheBus) {
  BoardLine line;
  line.open();
  std::vector<Time> ended_at;
  line.node.on_sent([&](const Frame& /*frame*/) { ended_at.push_back(line.now()); });
  for (std::uint32_t i = 0; i < 50; ++i) {
    line.node.send(numbered(i));
    line.run_for(Time(7'300'000 * (i % 5 + 1)));
  }
  ASSERT_EQ(line.arrived.size(), ended_at.size());
  for (std::size_t i = 0; i < ended_at.size(); ++i) {
    EXPECT_LT(std::chrono::abs(line.arrived[i].time - ended_at[i]), 2ms) << i;
  }
}

TEST(SerialFirmware, AWindowThatNobodyAcknowledgesEndsNoSession) {
  BoardLine line;
  line.open();
  line.node.controller().set_mode(sim::Controller::Mode::off);
  Source source(line);
  line.at_each_look = [&] { source.fill(); };
  line.run_for(3s);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.info().state, BridgeState::passive);
  EXPECT_EQ(line.session.down().resent, 0U);
  line.node.controller().set_mode(sim::Controller::Mode::normal);
  line.at_each_look = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 2s));
  EXPECT_EQ(line.session.down().sent, source.offered);
}

TEST(SerialFirmware, WithoutAControllerFramesWait) {
  BoardLine line;
  line.open();
  line.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  ASSERT_TRUE(
      line.run_until([&] { return line.session.info().state == BridgeState::no_controller; }, 2s));
  const std::vector<Frame> frames(20, numbered(1));
  ASSERT_EQ(line.session.offer(frames, line.now()), 20U);
  line.run_for(3s);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  line.board.set_chip_fault(sim::SpiWire::Fault::none);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 2s));
  EXPECT_EQ(line.session.down().sent, 20U);
  EXPECT_EQ(line.on_bus.size(), 20U);
}

TEST(SerialFirmware, ACrystalThatTurnsUpLateIsKnown) {
  BoardLine line({.bitrate_bps = 125'000, .mode = BridgeMode::listen});
  line.board.set_chip_fault(sim::SpiWire::Fault::stuck_high);
  line.open();
  EXPECT_EQ(line.session.info().state, BridgeState::no_controller);
  EXPECT_EQ(line.session.info().osc_khz, 0);
  line.board.set_chip_fault(sim::SpiWire::Fault::none);
  EXPECT_TRUE(line.run_until([&] { return line.session.info().osc_khz == 16'000; }, 1s));
  EXPECT_TRUE(line.session.info().interrupt_wired);
  line.run_for(1s);
  EXPECT_EQ(line.session.counters().sessions, 1U);
  EXPECT_EQ(line.session.info().state, BridgeState::active);
}

/// Its INT line stays low meanwhile, for it still holds frames.
TEST(SerialFirmware, AControllerLostOnAFullBusIsTakenUpAgain) {
  for (const auto fault : {sim::SpiWire::Fault::stuck_high, sim::SpiWire::Fault::stuck_low}) {
    for (const Time span : {Time(50us), Time(150ms)}) {
      SCOPED_TRACE(span.count());
      BoardLine line;
      line.open();
      line.run_for(700ms);
      Flood flood(line);
      line.run_for(100ms);
      line.board.set_chip_fault(fault);
      line.run_for(span);
      line.board.set_chip_fault(sim::SpiWire::Fault::none);
      line.run_for(700ms);
      const std::size_t arrived = line.arrived.size();
      line.run_for(200ms);
      EXPECT_GT(line.arrived.size(), arrived + 500);
      EXPECT_EQ(line.session.counters().sessions, 1U);
    }
  }
}

}  // namespace
}  // namespace roio::test
