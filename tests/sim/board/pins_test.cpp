// The pins of a board, and its timers (firmware/pins.cpp, firmware/idle.cpp).
#include <array>
#include <stdexcept>

#include "board_rig.hpp"

namespace roio::test {
namespace {

class BoardPins : public EachBoard {};
INSTANTIATE_TEST_SUITE_P(, BoardPins, all_boards, board_name);

TEST_P(BoardPins, APulseIsMeasuredToTheCycle) {
  BoardRig rig(bus_, GetParam(), "pins");
  EXPECT_EQ(rig.board.servo_pulse(9), std::nullopt);
  EXPECT_EQ(rig.board.servo_angle(9), std::nullopt);
  std::vector<sim::SimTime> edges;
  rig.board.on_pin(9, [&](sim::SimTime time, bool high) {
    EXPECT_EQ(time, bus_.now());
    EXPECT_EQ(high, edges.size() == 1) << "low as an output, high, low";
    edges.push_back(time);
  });
  bus_.run_for(100ms);
  EXPECT_EQ(rig.board.servo_pulse(9), sim::SimTime(1500us));
  EXPECT_NEAR(rig.board.servo_angle(9).value_or(0), (1500.0 - 544) * 180 / (2400 - 544), 1e-9);
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_EQ(edges[2] - edges[1], sim::SimTime(1500us));
}

TEST(ServoAngle, AsArduinoMapsIt) {
  EXPECT_DOUBLE_EQ(sim::servo_angle(544us), 0);
  EXPECT_DOUBLE_EQ(sim::servo_angle(1472us), 90);
  EXPECT_DOUBLE_EQ(sim::servo_angle(2400us), 180);
}

TEST_P(BoardPins, AConversionTakesThirteenClocksOf128Cycles) {
  BoardRig rig(bus_, GetParam(), "pins");
  bus_.run_for(100ms);
  ASSERT_GE(rig.words().size(), 1U);
  EXPECT_GE(rig.words()[0], 13 * 128);
  EXPECT_LE(rig.words()[0], 13 * 128 + 40);
}

TEST_P(BoardPins, AVoltageIsConverted) {
  const struct {
    double volts;
    int value;
  } rows[] = {{0, 0},         {0.0048, 0},    {0.0049, 1}, {1.0, 204}, {2.4999, 511}, {2.5, 512},
              {4.9902, 1021}, {4.9999, 1023}, {5, 1023},   {7, 1023},  {-0.3, 0}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.volts);
    sim::CanBus bus;
    BoardRig rig(bus, GetParam(), "pins");
    rig.board.set_analog(0, row.volts);
    rig.board.set_analog(1, 1.23);
    bus.run_for(20ms);
    ASSERT_GE(rig.words().size(), 2U);
    EXPECT_EQ(rig.words()[1], row.value);
  }
}

// LDS 2, SEI 1, NOP 1, response 4 (5 where the program counter has 22 bits), JMP 3.
TEST_P(BoardPins, AnInterruptTakesItsTime) {
  BoardRig rig(bus_, GetParam(), "pins");
  bus_.run_for(100ms);
  ASSERT_GE(rig.words().size(), 3U);
  EXPECT_EQ(rig.words()[2], GetParam() == sim::BoardKind::mega ? 12 : 11);
}

// 10 ms and what nine interrupts take: 1024 us each, and the rest in steps of 4 us.
TEST_P(BoardPins, Timer0CountsMicroseconds) {
  BoardRig rig(bus_, GetParam(), "pins");
  bus_.run_for(100ms);
  ASSERT_GE(rig.words().size(), 5U);
  const int us = rig.words()[3] * 1024 + rig.words()[4] * 4;
  EXPECT_GE(us, 10'000);
  EXPECT_LE(us, 10'000 + 9 * 4);
}

TEST_P(BoardPins, AButtonWithAPullUpLightsTheLed) {
  BoardRig rig(bus_, GetParam(), "pins");
  EXPECT_EQ(rig.board.pin(13), std::nullopt);
  bus_.run_for(100ms);
  EXPECT_EQ(rig.board.pin(4), std::nullopt) << "an input";
  EXPECT_EQ(rig.board.pin(13), false);
  std::vector<bool> led;
  rig.board.on_pin(13, [&](sim::SimTime /*time*/, bool high) { led.push_back(high); });
  rig.board.set_pin(4, false);
  bus_.run_for(50us);
  EXPECT_EQ(rig.board.pin(13), true);
  rig.board.set_pin(4, true);
  bus_.run_for(50us);
  rig.board.set_pin(4, false);
  bus_.run_for(50us);
  rig.board.release_pin(4);
  bus_.run_for(50us);
  EXPECT_EQ(led, (std::vector<bool>{true, false, true, false}));
}

TEST_P(BoardPins, AHeldButtonOutlastsAReset) {
  BoardRig rig(bus_, GetParam(), "pins");
  rig.board.set_pin(4, false);
  bus_.run_for(100ms);
  EXPECT_EQ(rig.board.pin(13), true);
  rig.board.reset();
  EXPECT_EQ(rig.board.pin(13), std::nullopt) << "all pins are inputs";
  bus_.run_for(100ms);
  EXPECT_EQ(rig.board.pin(13), true);
  rig.board.release_pin(4);
  rig.board.reset();
  bus_.run_for(100ms);
  EXPECT_EQ(rig.board.pin(13), false) << "the pull-up works again";
}

// An action that answers the board's own pin finds a board that has not run on.
TEST_P(BoardPins, AnActionIsFeltWithinALead) {
  BoardRig rig(bus_, GetParam(), "pins");
  bus_.run_for(100ms);
  std::vector<sim::SimTime> edges;
  rig.board.on_pin(13, [&](sim::SimTime time, bool high) {
    edges.push_back(time);
    rig.board.set_pin(4, high);  // the other way round: an oscillator
  });
  rig.board.set_pin(4, false);
  bus_.run_for(1ms);
  ASSERT_GT(edges.size(), 100U);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    EXPECT_LT(edges[i] - edges[i - 1], 1us + cpu_cycles(64));
  }
}

// firmware/interrupt.cpp: flags are kept and cleared, and a low level asks as long as it lasts.
TEST_P(BoardPins, ExternalInterrupts) {
  BoardRig rig(bus_, GetParam(), "interrupt", {.interrupt_pin = std::nullopt});
  int pulses = 0;
  rig.board.on_pin(9, [&](sim::SimTime /*time*/, bool high) { pulses += high ? 1 : 0; });
  rig.board.set_pin(2, true);
  bus_.run_for(1ms);
  rig.board.set_pin(2, false);
  bus_.run_for(1ms);
  const std::uint8_t flag = GetParam() == sim::BoardKind::uno        ? 0x01
                            : GetParam() == sim::BoardKind::leonardo ? 0x02
                                                                     : 0x10;
  EXPECT_EQ(rig.sent, (Bytes{flag, 0, 0}));
  rig.board.set_pin(2, true);
  bus_.run_for(1ms);
  rig.board.set_pin(2, false);
  bus_.run_for(30us);
  EXPECT_EQ(rig.sent, (Bytes{flag, 0, 0, 1})) << "it was off when the edge came";
  bus_.run_for(1ms);
  EXPECT_GT(pulses, 100) << "the line is still low";
  rig.board.set_pin(2, true);
  bus_.run_for(10us);
  const int before = pulses;
  bus_.run_for(1ms);
  EXPECT_EQ(pulses, before);
  rig.board.set_pin(2, false);
  bus_.run_for(100us);
  EXPECT_GT(pulses, before + 10);
}

TEST_P(BoardPins, WhatIsNotThere) {
  BoardRig rig(bus_, GetParam(), "pins");
  const int pins = rig.board.pins();
  EXPECT_THROW(rig.board.set_pin(pins, true), std::invalid_argument);
  EXPECT_THROW(rig.board.release_pin(-1), std::invalid_argument);
  EXPECT_THROW((void)rig.board.pin(pins), std::invalid_argument);
  EXPECT_THROW(rig.board.on_pin(pins, nullptr), std::invalid_argument);
  EXPECT_THROW((void)rig.board.servo_pulse(pins), std::invalid_argument);
  EXPECT_THROW(rig.board.set_analog(16, 0), std::invalid_argument);
  EXPECT_THROW((void)rig.board.analog_pin(-1), std::invalid_argument);
  EXPECT_THROW((void)rig.board.serial_waiting(rig.uart + 4), std::invalid_argument);
}

TEST(BoardPinNumbers, AreArduinos) {
  sim::CanBus bus;
  const auto board = [&](sim::BoardKind kind) {
    return std::make_unique<sim::Board>(bus, kind, firmware("idle", sim::mcu_of(kind)));
  };
  EXPECT_EQ(board(sim::BoardKind::uno)->analog_pin(5), 19);
  EXPECT_EQ(board(sim::BoardKind::leonardo)->analog_pin(0), 18);
  EXPECT_EQ(board(sim::BoardKind::mega)->analog_pin(15), 69);
  EXPECT_EQ(board(sim::BoardKind::uno)->pins(), 20);
  EXPECT_EQ(board(sim::BoardKind::leonardo)->pins(), 31);
  EXPECT_EQ(board(sim::BoardKind::mega)->pins(), 70);
}

TEST(BoardPinNumbers, HaveThePrintedNames) {
  using sim::BoardKind;
  struct Row {
    BoardKind kind;
    int number;
    const char* name;
    int first;
    const char* why;
  };
  const std::array<Row, 15> rows{{
      {BoardKind::uno, 6, "6", 6, "digital"},
      {BoardKind::uno, 15, "A1", 15, "analog"},
      {BoardKind::uno, 19, "A5", 19, "the last"},
      {BoardKind::leonardo, 6, "6", 6, "the first of two numbers"},
      {BoardKind::leonardo, 25, "6", 6, "A7, which is the same pin"},
      {BoardKind::leonardo, 24, "4", 4, "A6"},
      {BoardKind::leonardo, 29, "12", 12, "A11"},
      {BoardKind::leonardo, 18, "A0", 18, "analog alone"},
      {BoardKind::leonardo, 23, "A5", 23, "the last of these"},
      {BoardKind::leonardo, 14, "MISO", 14, "on the SPI header"},
      {BoardKind::leonardo, 16, "MOSI", 16, "on the SPI header"},
      {BoardKind::leonardo, 17, "RXLED", 17, "on no header"},
      {BoardKind::leonardo, 30, "TXLED", 30, "on no header"},
      {BoardKind::mega, 53, "53", 53, "digital"},
      {BoardKind::mega, 69, "A15", 69, "the last"},
  }};
  for (const Row& row : rows) {
    EXPECT_EQ(sim::pin_name(row.kind, row.number), row.name) << row.why;
    EXPECT_EQ(sim::main_pin(row.kind, row.number), row.first) << row.why;
  }
  EXPECT_EQ(sim::analog_pin(BoardKind::leonardo, 7), 25);
  EXPECT_THROW((void)sim::pin_name(BoardKind::uno, 20), std::invalid_argument);
  EXPECT_THROW((void)sim::main_pin(BoardKind::uno, -1), std::invalid_argument);
  EXPECT_THROW((void)sim::analog_pin(BoardKind::uno, 6), std::invalid_argument);
}

TEST(BoardWiring, ThatCannotBeIsRefused) {
  using sim::BoardKind;
  struct Row {
    BoardKind kind;
    int select;
    std::optional<int> interrupt;
    const char* refusal;
  };
  const std::array<Row, 13> rows{{
      {BoardKind::uno, 10, 2, ""},
      {BoardKind::uno, 9, std::nullopt, ""},
      {BoardKind::uno, 2, std::nullopt, ""},
      {BoardKind::uno, 14, 15, ""},
      {BoardKind::mega, 13, 12, ""},  // SPI's on an Uno
      {BoardKind::uno, 13, 2, "chip select cannot be on pin 13, which is SPI's SCK on a Uno"},
      {BoardKind::uno, 11, 2, "chip select cannot be on pin 11, which is SPI's MOSI on a Uno"},
      {BoardKind::mega, 50, 2, "chip select cannot be on pin 50, which is SPI's MISO on a Mega"},
      {BoardKind::uno, 10, 12, "INT cannot be on pin 12, which is SPI's MISO on a Uno"},
      {BoardKind::leonardo, 10, 15, "INT cannot be on pin 15, which is SPI's SCK on a Leonardo"},
      {BoardKind::uno, 2, 2, "chip select and INT cannot both be on pin 2"},
      {BoardKind::uno, 10, 10, "chip select and INT cannot both be on pin 10"},
      {BoardKind::leonardo, 6, 25, "chip select and INT cannot both be on pin 6"},
  }};
  for (const Row& row : rows) {
    sim::CanBus bus;
    std::string refusal;
    try {
      const sim::Board board(bus, row.kind, firmware("idle", sim::mcu_of(row.kind)),
                             {.chip_select_pin = row.select, .interrupt_pin = row.interrupt});
    } catch (const std::invalid_argument& error) {
      refusal = error.what();
    }
    EXPECT_EQ(refusal, row.refusal) << row.select;
  }
}

// Asleep between overflows of timer 0: as many as when awake.
TEST_P(BoardPins, SleepTakesNoLongerThanWaiting) {
  sim::SimTime period[2];
  for (const bool sleeps : {false, true}) {
    sim::CanBus bus;
    BoardRig rig(bus, GetParam(), "idle");
    if (sleeps) {
      rig.board.set_pin(4, false);
    }
    std::vector<sim::SimTime> edges;
    rig.board.on_pin(13, [&](sim::SimTime time, bool /*high*/) { edges.push_back(time); });
    bus.run_for(500ms);
    ASSERT_GE(edges.size(), 4U);
    period[sleeps] = edges[3] - edges[2];
    EXPECT_EQ(rig.board.state() == sim::Board::State::sleeping, sleeps);
  }
  EXPECT_NEAR(static_cast<double>(period[0] / 1us), 99 * 1024, 20);
  EXPECT_NEAR(static_cast<double>(period[1] / 1us), 99 * 1024, 20);
}

}  // namespace
}  // namespace roio::test
