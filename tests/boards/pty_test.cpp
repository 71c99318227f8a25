// A UART as a terminal: what any program with a serial port would do to it.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <roio/sim/serial_pty.hpp>
#include <thread>

#include "board_rig.hpp"

namespace roio::test {
namespace {

class Terminal {
 public:
  explicit Terminal(const std::string& path)
      : fd_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {}
  ~Terminal() { ::close(fd_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void write(const Bytes& bytes) const {
    ASSERT_EQ(::write(fd_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  // What comes until there is as much or, for a while, no more: the kernel takes its time.
  [[nodiscard]] Bytes read(std::size_t most, int patience_ms = 5000) const {
    Bytes bytes;
    pollfd ready{fd_, POLLIN, 0};
    while (bytes.size() < most && ::poll(&ready, 1, patience_ms) > 0) {
      std::array<std::uint8_t, 1024> some{};
      const ssize_t count = ::read(fd_, some.data(), std::min(some.size(), most - bytes.size()));
      if (count <= 0) {
        break;
      }
      bytes.insert(bytes.end(), some.begin(), some.begin() + count);
    }
    return bytes;
  }

 private:
  int fd_;
};

// Simulated time passes until it is so; the kernel hands on what was written in its own time.
bool runs_until(sim::CanBus& bus, const std::function<bool()>& it_is_so) {
  for (int i = 0; i < 5000 && !it_is_so(); ++i) {
    bus.run_for(1ms);
    std::this_thread::sleep_for(100us);
  }
  return it_is_so();
}

TEST(BoardPty, ThereAndBackWithEveryByte) {
  sim::CanBus bus;
  sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
  sim::SerialPty pty(bus, board, 0);
  const Terminal terminal(pty.path());
  bus.run_for(1ms);
  Bytes bytes{'e'};
  for (int byte = 255; byte >= 0; --byte) {  // control characters, too: the terminal is raw
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  terminal.write(bytes);
  EXPECT_TRUE(runs_until(bus, [&] { return board.serial_counters(0).sent == 256; }));
  bytes.erase(bytes.begin());
  EXPECT_EQ(terminal.read(256), bytes);
  EXPECT_EQ(pty.lost(), 0U);
}

TEST(BoardPty, MuchWaitsInTheTerminal) {
  sim::CanBus bus;
  sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
  sim::SerialPty pty(bus, board, 0);
  const Terminal terminal(pty.path());
  bus.run_for(1ms);
  terminal.write({'e'});
  const Bytes bytes(3000, 'x');
  terminal.write(bytes);
  std::size_t most = 0;
  Bytes back;
  EXPECT_TRUE(runs_until(bus, [&] {
    most = std::max(most, board.serial_waiting(0));
    const Bytes some = terminal.read(bytes.size(), 0);
    back.insert(back.end(), some.begin(), some.end());
    return back.size() == bytes.size();
  }));
  EXPECT_EQ(back, bytes);
  EXPECT_GT(most, 0U);
  EXPECT_LE(most, 256U);
  EXPECT_EQ(board.serial_counters(0).overruns, 0U);
}

TEST(BoardPty, WhatNobodyReadsIsCounted) {
  sim::CanBus bus;
  sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
  sim::SerialPty pty(bus, board, 0);
  bus.run_for(1ms);
  Bytes much(200'000, 'x');
  much.front() = 'e';
  board.serial_write(0, much);
  EXPECT_TRUE(runs_until(bus, [&] { return pty.lost() > 1000; }));
  const std::size_t lost = pty.lost();
  const std::size_t sent = board.serial_counters(0).sent;
  const Terminal terminal(pty.path());
  const std::size_t kept = terminal.read(sent - lost).size();
  EXPECT_EQ(kept + lost, sent);
  EXPECT_TRUE(terminal.read(1, 100).empty());
}

TEST(BoardPty, EndsBeforeItsBoard) {
  sim::CanBus bus;
  sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
  { const sim::SerialPty pty(bus, board, 0); }
  board.serial_write(0, Bytes{'t'});
  bus.run_for(10ms);
  EXPECT_THROW(sim::SerialPty(bus, board, 1), std::invalid_argument);
}

}  // namespace
}  // namespace roio::test
