// A UART as a terminal: what any program with a serial port would do to it.
#include <asm/termbits.h>  // for rates such as 954,000; not together with termios.h
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <roio/sim/serial_pty.hpp>
#include <system_error>
#include <thread>

#include "board_rig.hpp"

namespace roio::test {
namespace {

class Terminal {
 public:
  explicit Terminal(const std::string& path)
      : fd_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {}
  explicit Terminal(const sim::SerialPty& pty) : Terminal(pty.path()) {}
  ~Terminal() { ::close(fd_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void set_rate(unsigned bps) const {
    termios2 settings{};
    ASSERT_EQ(::ioctl(fd_, TCGETS2, &settings), 0);
    settings.c_cflag = (settings.c_cflag & ~static_cast<tcflag_t>(CBAUD)) | BOTHER;
    settings.c_ispeed = bps;
    settings.c_ospeed = bps;
    ASSERT_EQ(::ioctl(fd_, TCSETS2, &settings), 0);
  }
  // Whether the device is gone, as a program notices it.
  [[nodiscard]] bool has_hung_up() const {
    std::uint8_t byte = 0;
    return ::read(fd_, &byte, 1) == 0 && ::write(fd_, &byte, 1) == -1 && errno == EIO;
  }

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

// --- rates ---------------------------------------------------------------------------------------

// The board echoes at 1 Mbit/s.
class BoardPtyRate : public testing::Test {
 protected:
  BoardPtyRate() {
    bus_.run_for(1ms);
    board_.serial_write(0, Bytes{'e'});
    bus_.run_for(1ms);
  }
  // What comes back to the terminal: the board is to send `count` bytes.
  [[nodiscard]] Bytes echo_of(const Bytes& bytes, std::size_t count) {
    terminal_.write(bytes);
    echoed_ += count;
    EXPECT_TRUE(runs_until(bus_, [&] { return board_.serial_counters(0).sent == echoed_; }));
    bus_.run_for(1ms);
    return terminal_.read(count, 100);
  }

  sim::CanBus bus_;
  sim::Board board_{bus_, sim::BoardKind::uno, firmware("uart", "atmega328p")};
  sim::SerialPty pty_{bus_, board_, 0};
  Terminal terminal_{pty_};

 private:
  std::size_t echoed_ = 0;
};

TEST_F(BoardPtyRate, OfTheTerminalMattersOnceItIsSet) {
  const Bytes bytes{0x53, 0xD3, 0x2A};
  EXPECT_EQ(echo_of(bytes, 3), bytes);  // nobody has set it
  for (const unsigned near : {956'000U, 1'000'000U, 1'044'000U}) {
    terminal_.set_rate(near);
    EXPECT_EQ(echo_of(bytes, 3), bytes) << near;
  }
  EXPECT_EQ(pty_.garbled(), 0U);
  std::uint64_t garbled = 0;
  for (const unsigned off : {954'000U, 1'046'000U}) {
    terminal_.set_rate(off);
    EXPECT_NE(echo_of(bytes, 3), bytes) << off;
    garbled += 3 + 3;
    EXPECT_EQ(pty_.garbled(), garbled) << off;
  }
  terminal_.set_rate(1'000'000);
  EXPECT_EQ(echo_of(bytes, 3), bytes);
  EXPECT_EQ(pty_.garbled(), garbled);
}

// One end is always first: what passes until the other follows is nobody's mistake.
TEST_F(BoardPtyRate, AChangeOfRateIsNotAWrongOne) {
  terminal_.set_rate(1'000'000);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0x53});
  terminal_.set_rate(921'600);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  EXPECT_EQ(pty_.garbled(), 2U);
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 0U);
  terminal_.set_rate(1'000'000);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0x53});
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 0U) << "and it is over";

  terminal_.set_rate(921'600);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  bus_.run_for(1900ms);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 0U) << "not yet";
  bus_.run_for(200ms);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 6U) << "with those before";
  terminal_.set_rate(1'000'000);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0x53});
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 6U) << "what was wrong stays counted";
}

TEST_F(BoardPtyRate, ThatWasNeverRightIsWrongAtOnce) {
  terminal_.set_rate(921'600);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 2U);
  pty_.unplug();
  pty_.plug();
  EXPECT_EQ(pty_.garbled_by_wrong_rate(), 2U);
}

// To the board the fourth data bit twice, 53 to A3; and back, without the fourth, A3 to D3.
TEST_F(BoardPtyRate, NeitherEndUnderstandsTheOther) {
  terminal_.set_rate(921'600);
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  EXPECT_EQ(pty_.garbled(), 2U);
}

TEST_F(BoardPtyRate, StaysWhenItsProgramEndsAndGoesWithTheTerminal) {
  {
    const Terminal program(pty_);
    program.set_rate(921'600);
  }
  EXPECT_EQ(echo_of({0x53}, 1), Bytes{0xD3});
  pty_.unplug();
  pty_.plug();
  const Terminal program(pty_);
  program.write({0x53});
  EXPECT_TRUE(runs_until(bus_, [&] { return board_.serial_counters(0).sent == 2; }));
  bus_.run_for(1ms);
  EXPECT_EQ(program.read(1), Bytes{0x53});
}

// What the board sent before it changed its rate is heard at the rate of then.
TEST(BoardPty, TheRateIsThatOfEachByte) {
  sim::CanBus bus;
  sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
  sim::SerialPty pty(bus, board, 0, {.interval = 10ms});
  const Terminal terminal(pty);
  terminal.set_rate(1'000'000);
  bus.run_for(1ms);
  for (const Bytes& command : {Bytes{'t'}, Bytes{'r', 0, 3, 1}, Bytes{'t'}}) {
    board.serial_write(0, command);
    bus.run_for(2ms);
  }
  // The first sixteen at 1,000,000; the others, at 500,000, wait for the next look.
  EXPECT_EQ(terminal.read(16), (Bytes{'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', ':', ';',
                                      '<', '=', '>', '?'}));
  EXPECT_TRUE(terminal.read(1, 100).empty());
  bus.run_for(3ms);
  EXPECT_EQ(pty.garbled(), 16U);
  EXPECT_FALSE(terminal.read(1).empty());
}

// --- time ----------------------------------------------------------------------------------------

TEST(BoardPty, FastLinesLoseNothing) {
  for (const unsigned mega : {1U, 2U}) {
    sim::CanBus bus;
    sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
    sim::SerialPty pty(bus, board, 0);
    const Terminal terminal(pty);
    bus.run_for(1ms);
    board.serial_write(0, Bytes{'r', 0, static_cast<std::uint8_t>(2 / mega - 1), 1});
    bus.run_for(1ms);
    terminal.set_rate(mega * 1'000'000);
    terminal.write({'e'});
    Bytes bytes(3000);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::uint8_t>(1 + i % 255);
    }
    terminal.write(bytes);
    Bytes back;
    EXPECT_TRUE(runs_until(bus, [&] {
      const Bytes some = terminal.read(bytes.size(), 0);
      back.insert(back.end(), some.begin(), some.end());
      return back.size() >= bytes.size();
    }));
    EXPECT_EQ(back, bytes);
    EXPECT_EQ(board.serial_counters(0).overruns, 0U);
    EXPECT_EQ(pty.lost() + pty.garbled(), 0U);
  }
}

TEST(BoardPty, HandsOnWithinAnInterval) {
  sim::CanBus bus;
  sim::Board board(bus, sim::BoardKind::uno, firmware("uart", "atmega328p"));
  sim::SerialPty pty(bus, board, 0);
  const Terminal terminal(pty);
  bus.run_for(1ms);
  board.serial_write(0, Bytes{'?'});
  while (board.serial_counters(0).sent == 0) {
    bus.run_for(1us);
  }
  bus.run_for(51us);  // the AVR is up to 1 us ahead
  EXPECT_EQ(terminal.read(1), Bytes{'?'});
  EXPECT_THROW(sim::SerialPty(bus, board, 0, {.interval = 0us}), std::invalid_argument);
}

// --- plugged and unplugged -----------------------------------------------------------------------

class BoardPtyLink : public testing::Test {
 protected:
  BoardPtyLink() {
    std::string name = testing::TempDir() + "roio-pty-XXXXXX";
    folder_ = ::mkdtemp(name.data());
  }
  ~BoardPtyLink() override { std::filesystem::remove_all(folder_); }
  BoardPtyLink(const BoardPtyLink&) = delete;
  BoardPtyLink& operator=(const BoardPtyLink&) = delete;

  [[nodiscard]] std::filesystem::path link() const { return folder_ / "ttyACM0"; }
  [[nodiscard]] bool is_there() const { return std::filesystem::is_symlink(link()); }
  [[nodiscard]] std::string refusal() {
    try {
      sim::SerialPty(bus_, board_, 0, {.link = link()});
    } catch (const std::system_error& error) {
      return error.what();
    }
    return "";
  }

  sim::CanBus bus_;
  sim::Board board_{bus_, sim::BoardKind::uno, firmware("uart", "atmega328p")};

 private:
  std::filesystem::path folder_;
};

TEST_F(BoardPtyLink, LeadsToTheTerminalThatThereIs) {
  {
    sim::SerialPty pty(bus_, board_, 0, {.link = link()});
    EXPECT_EQ(std::filesystem::read_symlink(link()), pty.path());
    bus_.run_for(1ms);
    const Terminal before(link());
    EXPECT_FALSE(before.has_hung_up());

    pty.unplug();
    EXPECT_TRUE(before.has_hung_up());
    EXPECT_FALSE(pty.is_plugged());
    EXPECT_EQ(pty.path(), "");
    EXPECT_FALSE(is_there());
    board_.serial_write(0, Bytes{'t'});  // sixteen bytes
    bus_.run_for(1ms);
    EXPECT_EQ(pty.unheard(), 16U);

    pty.plug();
    EXPECT_TRUE(pty.is_plugged());
    EXPECT_EQ(std::filesystem::read_symlink(link()), pty.path());
    EXPECT_TRUE(before.has_hung_up());  // for good
    const Terminal after(link());
    after.write({'?'});
    EXPECT_TRUE(runs_until(bus_, [&] { return board_.serial_counters(0).sent == 17; }));
    bus_.run_for(1ms);
    EXPECT_EQ(after.read(1), Bytes{'?'});
    EXPECT_EQ(pty.unheard(), 16U);
    EXPECT_EQ(pty.lost(), 0U);
  }
  EXPECT_FALSE(is_there());
}

TEST_F(BoardPtyLink, TwiceIsOnce) {
  sim::SerialPty pty(bus_, board_, 0, {.link = link()});
  const Terminal terminal(pty);
  pty.plug();
  EXPECT_FALSE(terminal.has_hung_up());
  pty.unplug();
  pty.unplug();
  EXPECT_FALSE(pty.is_plugged());
}

TEST_F(BoardPtyLink, WhatWasSentAndNotHandedOnIsUnheard) {
  sim::SerialPty pty(bus_, board_, 0, {.interval = 10ms});
  bus_.run_for(1ms);
  board_.serial_write(0, Bytes{'t'});
  bus_.run_for(1ms);
  pty.unplug();
  EXPECT_EQ(pty.unheard(), 16U);
}

TEST_F(BoardPtyLink, TakesThePlaceOfAStaleOneOnly) {
  std::filesystem::create_symlink("/dev/pts/4711", link());
  {
    sim::SerialPty first(bus_, board_, 0, {.link = link()});
    EXPECT_EQ(std::filesystem::read_symlink(link()), first.path());
    sim::Board other(bus_, sim::BoardKind::uno, firmware("uart", "atmega328p"));
    const sim::SerialPty second(bus_, other, 0, {.link = link()});
    first.unplug();  // the link is not its own any more
    EXPECT_EQ(std::filesystem::read_symlink(link()), second.path());
  }
  EXPECT_FALSE(is_there());

  const std::string taken = link().string() +
                            ": expected nothing there, or a link to a pseudo terminal: "
                            "File exists";
  std::filesystem::create_symlink("/dev/null", link());
  EXPECT_EQ(refusal(), taken);
  std::filesystem::remove(link());
  std::ofstream(link()) << "a file";
  EXPECT_EQ(refusal(), taken);
  EXPECT_EQ(std::filesystem::file_size(link()), 6U);
}

}  // namespace
}  // namespace roio::test
