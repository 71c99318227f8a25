// Arduino's Serial, as a sketch has it: a UART, or a Leonardo's USB.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

class SerialEcho : public testing::TestWithParam<sim::BoardKind> {};

TEST_P(SerialEcho, SendsBackWhatItReceives) {
  sim::CanBus bus;
  sim::Board board(bus, GetParam(), image(GetParam(), "SerialEcho"));
  Bytes received;
  board.on_serial(0, [&](std::uint8_t byte) { received.push_back(byte); });
  bus.run_for(100ms);
  Bytes sent;
  for (int i = 0; i < 3000; ++i) {
    sent.push_back(static_cast<std::uint8_t>(i * 7));
  }
  board.serial_write(0, sent);
  bus.run_for(1s);
  EXPECT_EQ(received, sent);
  EXPECT_EQ(board.serial_waiting(0), 0U);
  EXPECT_EQ(board.serial_counters(0).sent, sent.size());
  EXPECT_EQ(board.serial_counters(0).received, sent.size());
  EXPECT_EQ(board.serial_counters(0).unheard, 0U);
}

TEST(SerialEchoOverUsb, APcThatTakesNothingGetsItLater) {
  sim::CanBus bus;
  const sim::BoardKind kind = sim::BoardKind::leonardo;
  sim::Board board(bus, kind, image(kind, "SerialEcho"));
  Bytes received;
  board.on_serial(0, [&](std::uint8_t byte) { received.push_back(byte); });
  bus.run_for(100ms);
  board.serial_hold(0, true);
  const Bytes sent(100, 0x2A);  // two packets
  board.serial_write(0, sent);
  bus.run_for(100ms);
  EXPECT_TRUE(received.empty());
  board.serial_hold(0, false);
  bus.run_for(100ms);
  EXPECT_EQ(received, sent);
}

TEST(SerialEchoOverUsb, WhatWaitsIsLostWithAResetAndCounted) {
  sim::CanBus bus;
  const sim::BoardKind kind = sim::BoardKind::leonardo;
  sim::Board board(bus, kind, image(kind, "SerialEcho"));
  bus.run_for(100ms);
  board.serial_hold(0, true);
  board.serial_write(0, Bytes(1000, 0x2A));
  bus.run_for(2s);  // the sketch waits 250 ms for each byte that finds no room, and gives it up
  const std::size_t waiting = board.serial_waiting(0);
  EXPECT_GT(waiting, 500U);
  board.reset();
  EXPECT_EQ(board.serial_waiting(0), 0U);
  EXPECT_EQ(board.serial_counters(0).unheard, waiting);
}

TEST(SerialEchoOverUsb, AUartCannotBeHeld) {
  sim::CanBus bus;
  const sim::BoardKind kind = sim::BoardKind::uno;
  sim::Board board(bus, kind, image(kind, "SerialEcho"));
  EXPECT_THROW(board.serial_hold(0, true), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Board, SerialEcho,
                         testing::Values(sim::BoardKind::uno, sim::BoardKind::leonardo,
                                         sim::BoardKind::mega),
                         [](const auto& row) { return std::string(sim::to_string(row.param)); });

}  // namespace
}  // namespace roio::test
