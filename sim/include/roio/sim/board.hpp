/// Board: an Arduino Uno, Leonardo or Mega with an MCP2515 on its SPI, running the very ELF file
/// that would be flashed to it. The AVR is libsimavr's; its SPI, UARTs, ADC results and interrupt
/// response are ours, because the times of simavr's are not true.
///
///   sim::CanBus bus;
///   sim::Board arm(bus, sim::BoardKind::uno, "arm.elf");
///   arm.set_pin(4, false);  // a button to ground
///   bus.run_for(std::chrono::milliseconds(100));
///   std::optional<sim::SimTime> width = arm.servo_pulse(9);
///
/// Time: all boards of a bus share its clock, at 16 MHz each. A board's AVR runs ahead of the bus,
/// as far as nothing can happen there, and by `lead` at most when something may; but whatever it
/// does to the chip (chip select, a byte of SPI) takes place at its exact time on the bus, and the
/// AVR waits for it. What comes from outside (the interrupt line, set_pin()) reaches it up to one
/// lead and one instruction late. The same run gives the same result every time.
///
/// A board must end before its bus. Callbacks come as actions of the bus, at their exact time: they
/// may run it. Not modelled: docs/internals/simulator.md, "Boards".
#ifndef ROIO_SIM_BOARD_HPP
#define ROIO_SIM_BOARD_HPP

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/mcp2515_chip.hpp>
#include <roio/sim/spi_wire.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace roio::sim {

/// A Micro is a leonardo.
enum class BoardKind : std::uint8_t { uno, leonardo, mega };
const char* to_string(BoardKind kind);
/// "atmega328p", "atmega32u4", "atmega2560".
const char* mcu_of(BoardKind kind);

// Pins have Arduino's numbers, and some have two: a Leonardo's 6 is 25, too, for analogRead(A7).
// All throw std::invalid_argument for a pin or an input that is not there.

/// The number of A0, A1...
int analog_pin(BoardKind kind, int channel);
/// The first of a pin's numbers.
int main_pin(BoardKind kind, int pin);
/// As it is printed on the board: "6", "A1". The Leonardo's own lights are "RXLED" and "TXLED".
std::string pin_name(BoardKind kind, int pin);

struct BoardOptions {
  std::string name{};                    ///< In error texts; empty: the kind and the file.
  int chip_select_pin = 10;              ///< Arduino's number.
  std::optional<int> interrupt_pin = 2;  ///< Where the chip's INT goes; none: not connected.
  Mcp2515Options chip{};
  bool has_chip = true;  ///< Without one, the AVR reads 0xFF.
  SimTime lead = std::chrono::microseconds(1);
};

/// The program came to an end that it should not have: thrown by the run of the bus, once.
class BoardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SerialCounters {
  std::uint64_t sent = 0;      ///< By the board, whole frames.
  std::uint64_t received = 0;  ///< That the board's receiver took.
  std::uint64_t overruns = 0;  ///< Lost, because the program did not read in time; DOR tells it.
  std::uint64_t unheard = 0;   ///< Lost, because the receiver was off.
  std::uint64_t unsent = 0;    ///< Written to a full data register, and so lost.
};

class Board {
 public:
  enum class State : std::uint8_t {
    running,
    sleeping,
    halted,   ///< It can never go on: asleep, or in an empty loop, with interrupts off.
    crashed,  ///< It did what an AVR cannot do: trouble() says what.
  };

  /// Powered on right now.
  /// @throws std::runtime_error: no such file, not an AVR's program, another MCU's, or too big.
  ///         std::invalid_argument: no such pin on this board, or chip select and INT where they
  ///         cannot be: on one another, on SPI's own pins.
  Board(CanBus& bus, BoardKind kind, const std::filesystem::path& elf,
        const BoardOptions& options = {});
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  [[nodiscard]] BoardKind kind() const;
  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] State state() const;
  /// Why it halted or crashed; else empty.
  [[nodiscard]] const std::string& trouble() const;
  /// The reset button. The chip keeps its state, but is deselected.
  void reset();
  /// Restarts so far, by reset() and by the watchdog.
  [[nodiscard]] std::uint64_t resets() const;
  /// The AVR's own clock, up to one lead ahead of the bus.
  [[nodiscard]] std::uint64_t cycles() const;
  [[nodiscard]] SimTime now() const;

  // --- the chip and its SPI ----------------------------------------------------------------------

  /// Its on_interrupt_pin() is the board's own.
  /// @throws std::logic_error: a board without one.
  [[nodiscard]] Mcp2515Chip& chip();
  /// The cable to the chip falls off, all at once, or is plugged in again.
  void set_chip_fault(SpiWire::Fault fault);
  /// A logic analyser: called after each byte, with what the AVR sent and what it got.
  void on_spi(std::function<void(SimTime, std::uint8_t out, std::uint8_t in)> listener);
  /// What the program does that a real board does not put up with: SCK or MOSI that is no output,
  /// an SPI mode that the chip does not know, a byte written while another is under way.
  /// Each kind is there once, with how often it came.
  [[nodiscard]] const std::vector<Mcp2515Violation>& violations() const;

  // --- pins: Arduino's numbers. All throw std::invalid_argument for one that is not there --------

  /// How many there are, counted from 0: 20, 31 (D14 to D17 are SPI, A0 is 18), 70 (A0 is 54).
  [[nodiscard]] int pins() const;
  /// The number of A0, A1...
  [[nodiscard]] int analog_pin(int channel) const;
  /// Something outside drives the pin: a switch to 5 V or to ground.
  void set_pin(int pin, bool high);
  /// Nothing does any more: its pull-up makes it high, or else it keeps its level.
  void release_pin(int pin);
  /// What the board drives it to; none while it is an input.
  [[nodiscard]] std::optional<bool> pin(int pin) const;
  /// Called when the board drives it to another level than before. In place of one set before.
  void on_pin(int pin, std::function<void(SimTime, bool)> listener);
  /// The voltage at an analog input, by Arduino's channel (0 is A0), 0..5; from the next
  /// conversion.
  void set_analog(int channel, double volts);
  /// How long the last whole pulse was high; none yet: none. To the cycle.
  [[nodiscard]] std::optional<SimTime> servo_pulse(int pin) const;
  /// The same as Arduino's Servo means it: 544 us is 0 degrees, 2400 us is 180.
  [[nodiscard]] std::optional<double> servo_angle(int pin) const;

  // --- serial ports, as Arduino numbers them: 0 is Serial, 1 is Serial1. All are UARTs, but for
  // the Leonardo's 0, which is USB with a PC at its other end: that sets it up some 10 ms after the
  // board starts. All throw std::invalid_argument for one that is not there ---------------------

  /// How many there are, counted from 0: 1, 2 (0 is USB), 4.
  [[nodiscard]] int serial_ports() const;
  /// Called with each byte that the board sent, at the end of its last bit, or of its USB packet.
  void on_serial(int port, std::function<void(std::uint8_t)> listener);
  /// Sends to the board, one byte after the other, at the rate that its program has set.
  void serial_write(int port, std::span<const std::uint8_t> bytes);
  /// Bytes of serial_write() that have not begun yet.
  [[nodiscard]] std::size_t serial_waiting(int port) const;
  /// The PC takes nothing of what the board sends, or does again.
  /// @throws std::invalid_argument: a UART, which has no flow control.
  void serial_hold(int port, bool holds);
  [[nodiscard]] const SerialCounters& serial_counters(int port) const;
  /// As programmed: 16 MHz / (16 or 8) / (UBRR + 1). None: USB, which has no such rate.
  [[nodiscard]] std::optional<double> serial_bitrate_bps(int port) const;
  /// Of the byte that on_serial() told last: the program may have set another since. None: of none.
  [[nodiscard]] std::optional<double> serial_sent_bitrate_bps(int port) const;

 private:
  class Machine;
  std::shared_ptr<Machine> machine_;
};

const char* to_string(Board::State state);

/// What Arduino's Servo means by a pulse, in degrees.
double servo_angle(SimTime pulse);

}  // namespace roio::sim

#endif
