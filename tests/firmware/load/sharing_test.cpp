// With interrupts off, and beside other devices on the same SPI, one of them used by an interrupt.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "rig.hpp"

namespace roio::load {
namespace {

constexpr std::uint8_t messages = 200;

/// Sends numbered messages, and gives the numbers that come back.
class Echoes {
 public:
  explicit Echoes(const std::string& name)
      : pc(bus, echo_bps), board(bus, sim::BoardKind::uno, image(name)) {
    pc.on_receive([this](const Frame& frame) { back.push_back(frame.data[0]); });
  }
  ~Echoes() { EXPECT_TRUE(board.violations().empty()) << board.violations().front().what; }
  Echoes(const Echoes&) = delete;
  Echoes& operator=(const Echoes&) = delete;

  void exchange(sim::SimTime apart) {
    for (std::uint8_t number = 0; number < messages; ++number) {
      pc.send(frame_of(pc_address, echo_address, Bytes(1 + number % 8U, number)));
      bus.run_for(apart);
    }
    bus.run_for(10ms);
  }
  void expect_all_back() const {
    ASSERT_EQ(back.size(), messages);
    for (std::size_t i = 0; i < messages; ++i) {
      ASSERT_EQ(back[i], static_cast<std::uint8_t>(i));
    }
    EXPECT_EQ(board.pin(5).value_or(false), false) << "interrupts came on";
  }

  sim::CanBus bus;
  sim::HostNode pc;
  sim::Board board;
  Bytes back;
};

// --- interrupts off ------------------------------------------------------------------------------

class InterruptsOff : public testing::TestWithParam<const char*> {};
const auto param_name = [](const testing::TestParamInfo<const char*>& name) {
  return std::string(name.param);
};
INSTANTIATE_TEST_SUITE_P(, InterruptsOff,
                         testing::Values("Polled", "Interrupt", "Portable", "Classic"), param_name);

TEST_P(InterruptsOff, BeginsReceivesAndSendsAndLeavesThemOff) {
  Echoes rig(std::string("InterruptsOff") + GetParam());
  rig.bus.run_for(start_up);
  rig.exchange(1ms);
  rig.expect_all_back();
}

// A sketch of 2014 begins once.
class InterruptsOffAgain : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, InterruptsOffAgain, testing::Values("Polled", "Interrupt", "Portable"),
                         param_name);

TEST_P(InterruptsOffAgain, BeginsAgain) {
  Echoes rig(std::string("InterruptsOff") + GetParam());
  rig.bus.run_for(start_up);
  rig.board.chip().power_cycle();
  rig.bus.run_for(200ms);
  rig.exchange(1ms);
  rig.expect_all_back();
}

// --- SPI is shared -------------------------------------------------------------------------------

constexpr int interrupt_pin = 3;
constexpr int chip_pin = 10;

/// Sees who is selected when a byte goes over the wires.
class SelectWatch {
 public:
  explicit SelectWatch(sim::Board& board) {
    for (int i = 0; i < 3; ++i) {
      board.on_pin(8 + i, [this, i](sim::SimTime, bool high) {
        selected_[i] = !high;
        together_ += selected_[0] + selected_[1] + selected_[2] > 1 ? 1 : 0;
        if (i < 2 && !high) {
          ++transactions[i];
        }
      });
    }
    board.on_spi([this](sim::SimTime, std::uint8_t out, std::uint8_t) {
      for (std::size_t i = 0; i < 2; ++i) {
        if (selected_[i]) {
          bytes[i].push_back(out);
        }
      }
    });
  }

  void check() const {
    EXPECT_EQ(together_, 0) << "two devices were selected at once";
    const Bytes expected[] = {{0xC3, 0x3C}, {0xA5, 0x5A}};
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_GT(transactions[i], 100) << "of device " << i;
      // The last one may be under way.
      EXPECT_LE(2U * static_cast<std::size_t>(transactions[i]) - bytes[i].size(), 2U);
      for (std::size_t at = 0; at < bytes[i].size(); ++at) {
        ASSERT_EQ(bytes[i][at], expected[i][at % 2]) << "byte " << at << " of device " << i;
      }
    }
  }

  int transactions[2] = {};
  Bytes bytes[2];

 private:
  bool selected_[3] = {};
  int together_ = 0;
};

class SharedSpi : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, SharedSpi, testing::Values("Polled", "Interrupt", "Portable"),
                         param_name);

TEST_P(SharedSpi, EachDeviceGetsItsOwnBytesAndNoMessageIsLost) {
  Echoes rig(std::string("SharedBus") + GetParam());
  rig.board.set_pin(interrupt_pin, true);
  rig.bus.run_for(start_up);
  SelectWatch watch(rig.board);
  // At any moment of the sketch's.
  std::mt19937 generator(1);
  std::function<void()> ring = [&] {
    rig.board.set_pin(interrupt_pin, false);
    rig.bus.after(5us, [&] { rig.board.set_pin(interrupt_pin, true); });
    rig.bus.after(60us + sim::SimTime(generator() % 80'000'000), ring);
  };
  ring();
  rig.exchange(1500us);
  rig.expect_all_back();
  watch.check();
  EXPECT_TRUE(rig.board.chip().violations().empty());
  EXPECT_GT(watch.transactions[1], 2000);
}

}  // namespace
}  // namespace roio::load
