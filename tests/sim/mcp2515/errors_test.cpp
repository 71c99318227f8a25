// Error counters and what they make of the chip: warning, error-passive, bus-off, recovery
// (datasheet, section 6).
#include "chip_rig.hpp"

namespace roio::test {
namespace {

struct Step {
  const char* why;
  int counter;
  int eflg;
  bool interrupts;
};

/// Runs until the register has that value, and shows neither it nor EFLG before time.
void run_until_counter(ChipRig& rig, std::uint8_t counter, int value) {
  for (int bit = 0; bit < 20'000 && rig.read(counter) != value; ++bit) {
    rig.run_bits(1);
  }
  ASSERT_EQ(rig.read(counter), value);
}

TEST(Mcp2515Errors, TransmitErrorsRaiseTheirFlagsAtTheirLimits) {
  constexpr Step steps[] = {
      {"first error", 8, 0x00, false},
      {"last below the warning limit", 88, 0x00, false},
      {"warning limit: TXWAR, EWARN", 96, 0x05, true},
      {"nothing new", 120, 0x05, false},
      {"error-passive: TXEP", 128, 0x15, true},
  };
  ChipRig rig;
  rig.silence_peer();
  rig.go();
  rig.load_standard(0, 0x123);
  rig.request_to_send(1);
  for (const Step& step : steps) {
    ASSERT_NO_FATAL_FAILURE(run_until_counter(rig, 0x1C, step.counter));
    EXPECT_EQ(rig.read(0x2D), step.eflg) << step.why;
    EXPECT_EQ(rig.read(0x2C) & 0x20, step.interrupts ? 0x20 : 0x00) << step.why;
    rig.write(0x2C, 0x00);
  }
  rig.wake_peer();
  rig.run_bits(200);
  EXPECT_EQ(rig.read(0x1C), 127);
  EXPECT_EQ(rig.read(0x2D), 0x05) << "error-active again";
  for (int left = 126; left >= 95; --left) {
    EXPECT_EQ(rig.read(0x2D), 0x05) << left + 1;
    rig.request_to_send(1);
    rig.run_bits(80);
    ASSERT_EQ(rig.read(0x1C), left);
  }
  EXPECT_EQ(rig.read(0x2D), 0x00);
  EXPECT_EQ(rig.read(0x2C) & 0x20, 0x00) << "getting better does not interrupt";
}

TEST(Mcp2515Errors, ReceiveErrorsRaiseTheirFlagsAtTheirLimits) {
  constexpr Step steps[] = {
      {"stuff error", 1, 0x00, false},
      {"first to find it", 9, 0x00, false},
      {"last below the warning limit", 89, 0x00, false},
      {"above it: RXWAR, EWARN", 97, 0x03, true},
      {"nothing new", 121, 0x03, false},
      {"error-passive: RXEP", 129, 0x0B, true},
  };
  ChipRig rig;
  rig.go();
  rig.silence_peer();
  rig.bus.hold_dominant(true);
  for (const Step& step : steps) {
    ASSERT_NO_FATAL_FAILURE(run_until_counter(rig, 0x1D, step.counter));
    EXPECT_EQ(rig.read(0x2D), step.eflg) << step.why;
    EXPECT_EQ(rig.read(0x2C) & 0x20, step.interrupts ? 0x20 : 0x00) << step.why;
    rig.write(0x2C, 0x00);
  }
  rig.run_bits(1000);
  EXPECT_EQ(rig.read(0x1D), 255) << "it goes no further";
  EXPECT_EQ(rig.read(0x2D), 0x0B) << "and a receiver never goes bus-off";
  rig.bus.hold_dominant(false);
  rig.wake_peer();
  rig.run_bits(50);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  rig.spi({0x90});
  EXPECT_EQ(rig.read(0x1D), 127);
  EXPECT_EQ(rig.read(0x2D), 0x03);
  for (int left = 126; left >= 95; --left) {
    EXPECT_EQ(rig.read(0x2D), 0x03) << left + 1;
    rig.peer_sends({0x123, FrameKind::standard, 0, {}});
    rig.spi({0x90});
    ASSERT_EQ(rig.read(0x1D), left);
  }
  EXPECT_EQ(rig.read(0x2D), 0x00);
}

/// Its transmitter cut off, a chip that sends hears that the wire is not what it drives.
struct BusOff : ChipRig {
  BusOff() {
    go();
    load_standard(1, 0x123);
    chip.controller().cut_transmitter(true);
    request_to_send(2);
    for (int bit = 0; bit < 20'000 && (read(0x2D) & 0x20) == 0; ++bit) {
      run_bits(1);
    }
    chip.controller().cut_transmitter(false);
  }
};

TEST(Mcp2515Errors, BusOffShowsInEflg) {
  BusOff rig;
  EXPECT_EQ(rig.read(0x2D), 0x35) << "TXBO, TXEP, TXWAR, EWARN";
  EXPECT_EQ(rig.read(0x1C), 255) << "the register has eight bits";
  EXPECT_EQ(rig.read(0x2C), 0xA0) << "ERRIF, MERRF";
  EXPECT_EQ(rig.read(0x40), 0x18) << "still requested";
  EXPECT_EQ(rig.chip.events().bus_offs, 1U);
}

TEST(Mcp2515Errors, BusOffNeitherSendsNorReceives) {
  BusOff rig;
  sim::HostNode witness(rig.bus, ChipRig::rate);
  rig.run_bits(20);
  rig.peer_sends({0x123, FrameKind::standard, 0, {}});
  EXPECT_EQ(rig.read(0x2C) & 0x03, 0x00);
  EXPECT_EQ(rig.on_bus, Texts{});
}

TEST(Mcp2515Errors, BusOffEndsAfter128Times11RecessiveBits) {
  BusOff rig;
  int bits = 0;
  while ((rig.read(0x2D) & 0x20) != 0 && bits < 2'000) {
    rig.run_bits(1);
    ++bits;
  }
  EXPECT_EQ(bits, 128 * 11);
  EXPECT_EQ(rig.read(0x2D), 0x00) << "without help";
  EXPECT_EQ(rig.read(0x1C), 0);
  EXPECT_EQ(rig.read(0x1D), 0);
  EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x00) << "normal mode all the time";
  rig.run_bits(200);
  EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"}) << "what was requested is sent now";
}

TEST(Mcp2515Errors, DominantBitsDelayTheRecovery) {
  BusOff rig;
  rig.bus.hold_dominant(true);
  rig.run_bits(3'000);
  rig.bus.hold_dominant(false);
  EXPECT_EQ(rig.read(0x2D) & 0x20, 0x20);
  rig.run_bits(128 * 11 - 2);
  EXPECT_EQ(rig.read(0x2D) & 0x20, 0x20);
  rig.run_bits(4);
  EXPECT_EQ(rig.read(0x2D) & 0x20, 0x00);
}

TEST(Mcp2515Errors, ConfigurationModeClearsTheCounters) {
  struct Row {
    const char* why;
    bool reset;
    int eflg;
  };
  constexpr Row rows[] = {{"entered by request: overflow flags are software's", false, 0xC0},
                          {"entered by reset", true, 0x00}};
  for (const Row& row : rows) {
    BusOff rig;
    rig.modify(0x2D, 0xC0, 0xC0);
    rig.write(0x40, 0x00);
    if (row.reset) {
      rig.spi({0xC0});
      rig.run_bits(10);
    } else {
      rig.write(0x0F, 0x80);
    }
    EXPECT_EQ(rig.read(0x0E) & 0xE0, 0x80) << row.why;
    EXPECT_EQ(rig.read(0x1C), 0) << row.why;
    EXPECT_EQ(rig.read(0x2D), row.eflg) << row.why;
    rig.go();
    rig.load_standard(1, 0x123);
    rig.request_to_send(2);
    rig.run_bits(200);
    EXPECT_EQ(rig.on_bus, Texts{"123 DLC 1 5A"}) << row.why << ": error-active";
  }
}

}  // namespace
}  // namespace roio::test
