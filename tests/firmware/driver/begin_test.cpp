// begin() on every kind of chip that one meets: it works, or says what is wrong, within its time.
#include <random>
#include <roio/frame_length.hpp>

#include "rig.hpp"
#include "seed.hpp"

namespace roio::test {
namespace {

using std::chrono::seconds;

/// Raw SPI, as another program would have used it.
void spi(sim::SpiWire& wire, std::initializer_list<int> bytes) {
  wire.select();
  for (const int byte : bytes) {
    wire.exchange(static_cast<std::uint8_t>(byte));
  }
  wire.deselect();
}

/// The registers that make the chip what it is: control, timing, filters, masks, buffers' control.
std::vector<int> setup_of(const sim::Mcp2515Chip& chip) {
  std::vector<int> values;
  for (int address = 0; address < 128; ++address) {
    const bool counter = address == 0x1C || address == 0x1D;
    const bool buffer = address >= 0x30 && (address & 0x0F) >= 1 && (address & 0x0F) <= 13;
    if (!counter && !buffer) {
      values.push_back(chip.peek(static_cast<std::uint8_t>(address)));
    }
  }
  return values;
}

TEST(Begin, SetsUpAChipThatIsThere) {
  Rig<> rig;
  EXPECT_EQ(rig.can.begin(plain_config()), Status::ok);
  EXPECT_TRUE(rig.can.running());
  EXPECT_EQ(rig.chip.bitrate_bps(), 500'000U);
  EXPECT_EQ(rig.chip.mode(), sim::Mcp2515Chip::OperationMode::normal);
  EXPECT_TRUE(rig.chip.violations().empty()) << rig.chip.violations().front().what;
  EXPECT_LT(rig.bus.now(), milliseconds(1) + milliseconds(1)) << "a millisecond, after one of rest";
  expect_it_works(rig);
  EXPECT_EQ(rig.can.state(), Mcp2515State::active);
}

TEST(Begin, WritesEachRegisterAsMeant) {
  Rig<true> rig;
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  // 16 MHz, 500 kbit/s: 16 quanta of 125 ns, sampled at 87.5 %.
  EXPECT_EQ(rig.chip.peek(0x2A), 0x00) << "CNF1: SJW 1, prescaler 1";
  EXPECT_EQ(rig.chip.peek(0x29), 0x80 | (6 << 3) | 5) << "CNF2: BTLMODE, PS1 7, PropSeg 6";
  EXPECT_EQ(rig.chip.peek(0x28), 0x41) << "CNF3: WAKFIL, PS2 2";
  EXPECT_EQ(rig.chip.peek(0x2B), 0x03) << "CANINTE: RX1IE, RX0IE";
  EXPECT_EQ(rig.chip.peek(0x2C), 0x1C) << "CANINTF: the three TXnIF, which stay";
  EXPECT_EQ(rig.chip.peek(0x60), 0x06) << "RXB0CTRL: by filters, BUKT and its copy";
  EXPECT_EQ(rig.chip.peek(0x70), 0x00) << "RXB1CTRL: by filters";
  for (const int address : {0x30, 0x40, 0x50}) {
    EXPECT_EQ(rig.chip.peek(static_cast<std::uint8_t>(address)), 2) << "TXBnCTRL: all alike";
  }
  EXPECT_EQ(rig.chip.peek(0x0F), 0x07) << "CANCTRL: normal mode, clock output as after a reset";
  // docs/protocol.md "Filters", the plain node 0.2.
  const std::vector<int> mask{0x1F, 0xE3, 0xE0, 0x00};
  const std::vector<int> to_node{0x00, 0x08, 0x40, 0x00};
  const std::vector<int> to_all{0x00, 0xEB, 0xE0, 0x00};
  const std::vector<std::pair<int, std::vector<int>>> expected{
      {0x20, mask},    {0x24, mask},    {0x00, to_node}, {0x04, to_all},
      {0x08, to_node}, {0x10, to_node}, {0x14, to_all},  {0x18, to_node}};
  for (const auto& [address, bytes] : expected) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(rig.chip.peek(static_cast<std::uint8_t>(address + static_cast<int>(i))), bytes[i])
          << "register " << std::hex << address << " + " << i;
    }
  }
}

TEST(Begin, WithoutAChipSaysSoInTime) {
  for (const auto fault : {sim::SpiWire::Fault::stuck_low, sim::SpiWire::Fault::stuck_high}) {
    Rig<> rig;
    rig.wire.set_fault(fault);
    const sim::SimTime start = rig.bus.now();
    EXPECT_EQ(rig.can.begin(plain_config()), Status::no_chip);
    EXPECT_LT(rig.bus.now() - start, milliseconds(55));
    EXPECT_FALSE(rig.can.running());
    Frame frame{};
    EXPECT_EQ(rig.can.poll(), Status::no_chip);
    EXPECT_EQ(rig.can.receive(frame), Status::no_chip);
    EXPECT_EQ(rig.can.send(numbered(1)), Status::no_chip);
    rig.can.abort();
    rig.wire.set_fault(sim::SpiWire::Fault::none);
    EXPECT_EQ(rig.can.begin(plain_config()), Status::ok) << "plugged in now";
    expect_it_works(rig);
  }
}

TEST(Begin, NoticesAWriteThatDidNotArrive) {
  // Chip select is lost at each byte in turn of what sets up a chip that is there.
  Rig<> whole;
  whole.mark();
  ASSERT_EQ(whole.can.begin(plain_config()), Status::ok);
  const auto bytes = static_cast<std::uint32_t>(whole.spent().first);
  int noticed = 0;
  for (std::uint32_t byte = 0; byte < bytes; ++byte) {
    Rig<> rig;
    rig.wire.lose_select_after(byte);
    const Status status = rig.can.begin(plain_config());
    noticed += status == Status::no_chip ? 1 : 0;
    if (status == Status::ok) {
      ASSERT_EQ(setup_of(rig.chip), setup_of(whole.chip)) << byte;
    }
  }
  EXPECT_GT(noticed, 40);
}

TEST(Begin, RefusesAnImpossibleTimingWithoutTouchingTheChip) {
  Rig<> rig;
  rig.begin();
  EXPECT_EQ(rig.can.begin({compute_bit_timing(8'000'000, 1'000'000), mcp2515_filters_of(own)}),
            Status::bad_timing);
  EXPECT_EQ(rig.spent().first, 0U);
  EXPECT_TRUE(rig.can.running()) << "as before";
  expect_it_works(rig);
}

static_assert(!std::is_convertible_v<Mcp2515Filters, Mcp2515FilterPair>,
              "six filters that cannot keep the order are no configuration");

TEST(Begin, RefusesWhatItsTraitsLeaveOut) {
  Rig<false, 0, 0, Mcp2515Traits> rig;
  rig.begin();
  EXPECT_EQ(rig.can.begin(plain_config(mcp2515::Mode::normal, true)), Status::bad_argument)
      << "one-shot, and nobody told what became of a frame";
  EXPECT_EQ(rig.can.begin(plain_config(mcp2515::Mode::configuration)), Status::bad_argument);
  EXPECT_EQ(rig.spent().first, 0U);
  expect_it_works(rig);
}

TEST(Begin, WaitsForAChipThatStartsSlowly) {
  for (const int start_ms : {1, 5, 15}) {
    sim::CanBus bus;
    sim::HostNode peer(bus, 500'000);
    sim::Mcp2515Chip chip(bus, {.crystal_start = milliseconds(start_ms)});
    sim::SpiWire wire(bus, chip);
    Mcp2515<sim::ChipPort<false>> can(wire);
    EXPECT_EQ(can.begin(plain_config()), Status::ok) << start_ms;
    EXPECT_LT(bus.now(), milliseconds(start_ms + 2));
  }
}

TEST(Begin, GivesUpOnAChipThatStartsTooSlowly) {
  sim::CanBus bus;
  sim::Mcp2515Chip chip(bus, {.crystal_start = milliseconds(60)});
  sim::SpiWire wire(bus, chip);
  Mcp2515<sim::ChipPort<false>> can(wire);
  EXPECT_EQ(can.begin(plain_config()), Status::no_chip);
  EXPECT_LT(bus.now(), milliseconds(55));
  EXPECT_EQ(can.begin(plain_config()), Status::ok) << "the second time";
}

TEST(Begin, WakesASleepingChip) {
  for (const bool wake_up_enabled : {false, true}) {
    Rig<> rig;
    rig.begin();
    spi(rig.wire, {0x05, 0x2B, 0x40, wake_up_enabled ? 0x40 : 0});
    spi(rig.wire, {0x05, 0x0F, 0xE0, 0x20});
    rig.bus.run_for(milliseconds(1));
    ASSERT_EQ(rig.chip.mode(), sim::Mcp2515Chip::OperationMode::sleep);
    EXPECT_EQ(rig.can.begin(plain_config()), Status::ok);
    expect_it_works(rig);
  }
}

TEST(Begin, FromAnyStateEndsInTheSame) {
  std::mt19937 generator = seeded_generator();
  Rig<> fresh;
  ASSERT_EQ(fresh.can.begin(plain_config()), Status::ok);
  const std::vector<int> expected = setup_of(fresh.chip);
  for (int round = 0; round < 200; ++round) {
    Rig<> rig;
    // A previous program wrote anything anywhere, in configuration mode and in others, and left in
    // the middle of an instruction.
    for (int i = 0; i < 200; ++i) {
      const auto address = static_cast<int>(up_to(generator, 127));
      spi(rig.wire, {0x02, address, static_cast<int>(up_to(generator, 255))});
      rig.bus.run_for(microseconds(up_to(generator, 100)));
    }
    rig.wire.select();
    rig.wire.exchange(0x02);
    rig.wire.deselect();
    ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
    ASSERT_EQ(setup_of(rig.chip), expected);
  }
}

TEST(Begin, ASecondTimeKeepsTheQueuesAndTellsWhatTheChipHad) {
  Rig<false, 4, 4> rig;
  rig.begin();
  rig.peer_sends({numbered(1), numbered(2)});
  ASSERT_EQ(rig.can.poll(), Status::ok);  // both are in the queue now
  rig.peer.controller().set_mode(sim::Controller::Mode::off);
  for (std::uint8_t i = 0; i < 4; ++i) {
    ASSERT_EQ(rig.can.send(numbered(10U + i), i), Status::ok);
  }
  rig.bus.run_for(milliseconds(1));
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  EXPECT_EQ(rig.can.traits().outcomes,
            (std::vector<Outcome>{{0, TxOutcome::unknown}, {1, TxOutcome::unknown}}));
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered(1), numbered(2)}));
  rig.peer.controller().set_mode(sim::Controller::Mode::normal);
  rig.bus.run_for(milliseconds(1));
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(rig.can.poll(), Status::ok);
    rig.bus.run_for(milliseconds(1));
  }
  EXPECT_EQ(rig.peer_received, (std::vector{numbered(12), numbered(13)}));
  EXPECT_EQ(rig.can.counters().unknown, 2U);
}

TEST(Begin, OnABusThatIsNeverIdleSaysSoInTime) {
  Rig<> rig;
  rig.bus.hold_dominant(true);
  const sim::SimTime start = rig.bus.now();
  EXPECT_EQ(rig.can.begin(plain_config()), Status::wrong_mode);
  EXPECT_LT(rig.bus.now() - start, milliseconds(55));
  rig.bus.hold_dominant(false);
  rig.bus.run_for(milliseconds(10));
  EXPECT_EQ(rig.chip.mode(), sim::Mcp2515Chip::OperationMode::configuration)
      << "it does not join behind the program's back";
  EXPECT_EQ(rig.can.begin(plain_config()), Status::ok);
  expect_it_works(rig);
}

TEST(Begin, OnABusyBusTakesPartAtTheNextGap) {
  Rig<> rig;
  rig.peer.on_sent([&](const Frame& frame) { rig.peer.send(frame); });
  rig.peer.send({0x08000001, FrameKind::extended, 8, {}});
  rig.peer.send({0x08000001, FrameKind::extended, 8, {}});
  sim::HostNode other(rig.bus, 500'000);
  rig.bus.run_for(milliseconds(2));
  EXPECT_EQ(rig.can.begin(plain_config()), Status::ok);
}

TEST(Begin, InListenOnlyModeDisturbsNobody) {
  Rig<> rig;
  // The bus runs at 500 kbit/s.
  const auto config = plain_config<125'000>(mcp2515::Mode::listen_only);
  ASSERT_EQ(rig.can.begin(config), Status::ok);
  sim::HostNode other(rig.bus, 500'000);
  rig.bus.run_for(milliseconds(1));
  for (std::uint32_t i = 0; i < 50; ++i) {
    rig.peer.send(numbered(i));
  }
  rig.bus.run_for(milliseconds(100));
  EXPECT_EQ(rig.bus.statistics().frames, 50U);
  EXPECT_EQ(rig.bus.statistics().transmit_errors, 0U);
  EXPECT_TRUE(rig.receive_all().empty());
}

TEST(Stop, TakesTheChipOffTheBusAndTellsWhatItHad) {
  Rig<> rig;
  rig.begin();
  rig.peer_sends({numbered(1), numbered(2)});
  EXPECT_EQ(rig.can.stop(), Status::ok);
  EXPECT_EQ(rig.chip.mode(), sim::Mcp2515Chip::OperationMode::configuration);
  EXPECT_FALSE(rig.can.running());
  EXPECT_EQ(rig.can.counters().discarded, 2U);
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  expect_it_works(rig);
}

TEST(Begin, AtTheWrongRateShowsInTheCounters) {
  Rig<> rig;
  ASSERT_EQ(rig.can.begin(plain_config<125'000>()), Status::ok) << "nothing on the bus says so yet";
  sim::HostNode other(rig.bus, 500'000);
  for (std::uint32_t i = 0; i < 200; ++i) {
    rig.peer.send(numbered(i));
    rig.bus.run_for(milliseconds(2));
    ASSERT_EQ(rig.can.poll(), Status::ok);
  }
  EXPECT_TRUE(rig.receive_all().empty());
  EXPECT_GT(rig.can.counters().message_errors, 0U);
  EXPECT_NE(rig.can.state(), Mcp2515State::active);
  EXPECT_EQ(rig.peer.waiting(), 0U) << "in the end it is passive, and lets the others work";
}

// --- the oscillator ------------------------------------------------------------------------------

struct Crystal {
  const char* why;
  std::uint32_t real_hz;
  std::uint32_t told_hz;
  Status expected;
};

constexpr Crystal crystals[] = {
    {"as told", 16'000'000, 16'000'000, Status::ok},
    {"as told", 8'000'000, 8'000'000, Status::ok},
    {"the boards' usual mistake", 8'000'000, 16'000'000, Status::wrong_clock},
    {"the other way round", 16'000'000, 8'000'000, Status::wrong_clock},
    {"four times too slow", 4'000'000, 16'000'000, Status::wrong_clock},
    {"near, and wrong", 20'000'000, 16'000'000, Status::wrong_clock},
    {"near, and wrong", 16'000'000, 20'000'000, Status::wrong_clock},
    {"near, and wrong", 10'000'000, 8'000'000, Status::wrong_clock},
    {"near, and wrong", 8'000'000, 10'000'000, Status::wrong_clock},
};

TEST(CheckClock, TellsWhatCrystalIsThere) {
  for (const std::uint32_t bitrate : {10'000U, 20'000U, 125'000U, 500'000U, 1'000'000U}) {
    for (const Crystal& row : crystals) {
      SCOPED_TRACE(std::string(row.why) + ": " + std::to_string(row.real_hz) + " told " +
                   std::to_string(row.told_hz) + " at " + std::to_string(bitrate));
      const Mcp2515Config config(compute_bit_timing(row.told_hz, bitrate), mcp2515_filters_of(own));
      if (!config.timing_is_valid()) {
        continue;
      }
      Rig<> rig({.chip = {.osc_hz = row.real_hz}});
      std::uint32_t measured = 0;
      EXPECT_EQ(rig.can.check_clock(config, row.told_hz, measured), row.expected);
      EXPECT_NEAR(measured, row.real_hz, 0.05 * row.real_hz);
      EXPECT_EQ(rig.bus.statistics().busy, sim::SimTime(0)) << "nothing on the bus";
      EXPECT_EQ(rig.chip.mode(), sim::Mcp2515Chip::OperationMode::configuration);
      if (row.expected == Status::ok) {
        EXPECT_EQ(rig.can.begin(config), Status::ok);
      }
    }
  }
}

TEST(CheckClock, TakesAFrameWithoutStuffBits) {
  Frame frame{mcp2515::clock_frame_id, FrameKind::extended, 8, {}};
  std::fill(std::begin(frame.data), std::end(frame.data), mcp2515::clock_frame_data);
  EXPECT_EQ(wire_bits(frame), mcp2515::clock_frame_bits);
}

TEST(CheckClock, SaysWhatElseIsWrong) {
  Rig<> rig;
  std::uint32_t measured = 1;
  const Mcp2515Config config(BitTiming{}, mcp2515_filters_of(own));
  EXPECT_EQ(rig.can.check_clock(config, 16'000'000, measured), Status::bad_timing);
  EXPECT_EQ(measured, 0U);
  EXPECT_EQ(rig.can.check_clock(plain_config(), 16, measured), Status::bad_argument)
      << "megahertz where hertz are asked for";
  rig.wire.set_fault(sim::SpiWire::Fault::stuck_high);
  EXPECT_EQ(rig.can.check_clock(plain_config(), 16'000'000, measured), Status::no_chip);
}

}  // namespace
}  // namespace roio::test
