#include <roio/sim/board.hpp>
#include <stdexcept>
#include <utility>

#include "board/machine.hpp"

namespace roio::sim {
namespace {

constexpr double zero_degrees_us = 544;
constexpr double half_turn_us = 2400;
constexpr double half_turn = 180;

}  // namespace

Board::Board(CanBus& bus, BoardKind kind, const std::filesystem::path& elf,
             const BoardOptions& options)
    : machine_(std::make_shared<Machine>(bus, kind, elf, options)) {}

Board::~Board() = default;

BoardKind Board::kind() const {
  return machine_->model().kind;
}
const std::string& Board::name() const {
  return machine_->name;
}
Board::State Board::state() const {
  return machine_->core.state();
}
const std::string& Board::trouble() const {
  return machine_->core.trouble();
}
void Board::reset() {
  machine_->reset();
}
std::uint64_t Board::resets() const {
  return machine_->resets;
}
std::uint64_t Board::cycles() const {
  return machine_->core.cycle();
}
SimTime Board::now() const {
  return machine_->now();
}

Mcp2515Chip& Board::chip() {
  Mcp2515Chip* const chip = machine_->wiring.chip();
  if (chip == nullptr) {
    throw std::logic_error(name() + " has no chip");
  }
  return *chip;
}

void Board::set_chip_fault(SpiWire::Fault fault) {
  machine_->wiring.set_fault(fault);
}

void Board::on_spi(std::function<void(SimTime, std::uint8_t out, std::uint8_t in)> listener) {
  machine_->listened_to();
  machine_->spi_listener = std::move(listener);
}

const std::vector<Mcp2515Violation>& Board::violations() const {
  return machine_->violations;
}

int Board::pins() const {
  return static_cast<int>(machine_->model().pins.size());
}

int Board::analog_pin(int channel) const {
  return sim::analog_pin(kind(), channel);
}

void Board::set_pin(int pin, bool high) {
  machine_->drive(pin, high);
}
void Board::release_pin(int pin) {
  machine_->drive(pin, std::nullopt);
}

std::optional<bool> Board::pin(int pin) const {
  return machine_->ports.level(machine_->pins.mcu_pin(pin));
}

void Board::on_pin(int pin, std::function<void(SimTime, bool)> listener) {
  machine_->listened_to();
  machine_->pins.at(pin).listener = std::move(listener);
}

void Board::set_analog(int channel, double volts) {
  machine_->adc.set(machine_->pins.adc_channel(channel), volts);
}

std::optional<SimTime> Board::servo_pulse(int pin) const {
  const std::optional<AvrCore::Cycle> pulse = machine_->pins.at(pin).pulse;
  return pulse ? std::optional(static_cast<std::int64_t>(*pulse) * cycle_time) : std::nullopt;
}

std::optional<double> Board::servo_angle(int pin) const {
  const std::optional<SimTime> pulse = servo_pulse(pin);
  return pulse ? std::optional(sim::servo_angle(*pulse)) : std::nullopt;
}

int Board::serial_ports() const {
  const BoardModel& model = machine_->model();
  return static_cast<int>(model.uarts.size()) + (model.has_usb ? 1 : 0);
}

void Board::on_serial(int port, std::function<void(std::uint8_t)> listener) {
  machine_->listened_to();
  machine_->serials.listen(port, std::move(listener));
}

void Board::serial_write(int port, std::span<const std::uint8_t> bytes) {
  machine_->serials.line(port).receive(bytes);
}

std::size_t Board::serial_waiting(int port) const {
  return machine_->serials.line(port).waiting();
}

void Board::serial_hold(int port, bool holds) {
  if (!machine_->serials.line(port).hold(holds)) {
    throw std::invalid_argument(name() + ": serial port " + std::to_string(port) +
                                " is a UART, which nobody can hold");
  }
}

const SerialCounters& Board::serial_counters(int port) const {
  return std::as_const(machine_->serials.line(port)).counters();
}

std::optional<double> Board::serial_bitrate_bps(int port) const {
  return machine_->serials.line(port).bitrate_bps();
}

std::optional<double> Board::serial_sent_bitrate_bps(int port) const {
  return machine_->serials.sent_bps(port);
}

const char* to_string(Board::State state) {
  switch (state) {
    case Board::State::running:
      return "running";
    case Board::State::sleeping:
      return "sleeping";
    case Board::State::halted:
      return "halted";
    case Board::State::crashed:
      break;
  }
  return "crashed";
}

double servo_angle(SimTime pulse) {
  const double us = std::chrono::duration<double, std::micro>(pulse).count();
  return (us - zero_degrees_us) * half_turn / (half_turn_us - zero_degrees_us);
}

}  // namespace roio::sim
