#include <gtest/gtest.h>

#include <roio/mcp2515.hpp>
#include <roio/sim/spi_wire.hpp>

namespace roio {
namespace {

TEST(Begin, SetsUpAChipThatIsThere) {
  sim::CanBus bus;
  sim::Mcp2515Chip chip(bus);
  sim::SpiWire wire(bus, chip);
  bus.run_for(std::chrono::milliseconds(1));
  Mcp2515<sim::ChipPort<false>> can(wire);
  const Mcp2515Config config(bit_timing<16000000, 500000>(), mcp2515_filters_of(Address{0, 2}));
  EXPECT_EQ(can.begin(config), Status::ok);
  EXPECT_EQ(chip.bitrate_bps(), 500'000U);
  EXPECT_TRUE(chip.violations().empty());
}

}  // namespace
}  // namespace roio
