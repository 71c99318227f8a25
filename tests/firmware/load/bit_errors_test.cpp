// Echo for a minute (scripts/soak: an hour) on a bus with bit errors: it lives, and every message
// is accounted for. At 1 % of bits hardly a frame is whole: both nodes are error-passive most of
// the time, and bus-off dozens of times a second.
#include "bit_errors.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "spans.hpp"

namespace roio::load {
namespace {

using namespace std::chrono_literals;

void check_sums(const BitErrorReport& report) {
  EXPECT_TRUE(report.alive);
  // On the way there: all that the PC sent was accepted, or is one of these losses.
  EXPECT_EQ(report.sent, report.accepted - report.repeated - report.corrupted + report.missing);
  // In the board: the driver took all that the chip accepted, Echo sent all that it was given, and
  // the chip was never lost.
  const auto counted = [](std::uint64_t number) { return static_cast<std::uint16_t>(number); };
  EXPECT_EQ(counted(report.accepted), counted(report.echo_received + report.echo_foreign));
  EXPECT_EQ(report.echo_received, counted(report.echo_sent + report.echo_keeps));
  EXPECT_EQ(report.echo_sent, counted(report.chip_sent));
  EXPECT_EQ(report.echo_keeps, 0U);
  EXPECT_EQ(report.echo_unknown, 0U);
  EXPECT_EQ(report.echo_chip_losses, 0U);
  // What the chip lost is told: once for one or more.
  EXPECT_EQ(report.overflowed == 0, report.echo_overflows == 0);
  EXPECT_LE(report.echo_overflows, report.overflowed);
  // On the way back.
  EXPECT_EQ(report.disordered, 0U);
  EXPECT_LE(report.corrupted + report.back_corrupted, report.transmit_errors / 10'000)
      << "a CRC of 15 bits lets one in 32,768 through";
}

void print(const BitErrorReport& report) {
  std::cout << report.sent << " sent, " << report.accepted << " accepted (" << report.repeated
            << " twice), " << report.missing << " missing (" << report.overflowed
            << " overflowed, told " << report.echo_overflows << " times), " << report.chip_sent
            << " sent back, " << report.back << " came back (" << report.back_repeated
            << " twice), " << report.corrupted + report.back_corrupted << " corrupted; "
            << report.flipped_bits << " bits flipped, " << report.transmit_errors
            << " attempts failed, bus-off " << report.chip_bus_offs << " and " << report.pc_bus_offs
            << " times\n";
}

TEST(EchoUnderBitErrors, OnePercent) {
  const BitErrorReport report = echo_under_bit_errors(0.01, 1, soak_span(60s));
  print(report);
  check_sums(report);
  EXPECT_GT(report.chip_bus_offs, 10U);
  EXPECT_GT(report.sent, 500U);
}

TEST(EchoUnderBitErrors, OnePerMille) {
  const BitErrorReport report = echo_under_bit_errors(0.001, 2, soak_span(10s));
  print(report);
  check_sums(report);
  EXPECT_GT(report.sent, 1000U);
}

TEST(EchoUnderBitErrors, NoneForComparison) {
  const BitErrorReport report = echo_under_bit_errors(0, 3, 1s);
  check_sums(report);
  EXPECT_EQ(report.missing + report.repeated + report.back_repeated, 0U);
  EXPECT_EQ(report.back, report.sent);
  EXPECT_EQ(report.transmit_errors, 0U);
}

}  // namespace
}  // namespace roio::load
