// Power and modes of the simulated MCP2515 (8 to 10). Each other subject has a file of its own.
#include <memory>
#include <random>
#include <roio/sim/mcp2515_chip.hpp>
#include <utility>

#include "mcp2515/map.hpp"

namespace roio::sim {
namespace {

constexpr std::int64_t start_up_clocks = 128;  // oscillator start-up timer (8.1)

constexpr bool is_mode(std::uint8_t request) {
  return request <= static_cast<std::uint8_t>(Mcp2515Chip::OperationMode::configuration);
}

}  // namespace

const char* to_string(Mcp2515Chip::OperationMode mode) {
  switch (mode) {
    case Mcp2515Chip::OperationMode::normal:
      return "normal";
    case Mcp2515Chip::OperationMode::sleep:
      return "sleep";
    case Mcp2515Chip::OperationMode::loopback:
      return "loopback";
    case Mcp2515Chip::OperationMode::listen_only:
      return "listen-only";
    case Mcp2515Chip::OperationMode::configuration:
      return "configuration";
  }
  return "unknown";
}

Mcp2515Chip::Mcp2515Chip(CanBus& bus, const Mcp2515Options& options)
    : bus_(bus), options_(options), controller_(*this) {
  start(true);
}

Mcp2515Chip::~Mcp2515Chip() {
  bus_.leave(controller_);
}

void Mcp2515Chip::violation(std::string what) {
  ++violation_count_;
  if (violations_.size() < most_violations) {
    violations_.push_back({bus_.now(), std::move(what)});
  }
}

void Mcp2515Chip::later(SimTime span, std::function<void()> action) {
  bus_.after(span, [era = std::weak_ptr<const void>(era_), action = std::move(action)] {
    if (!era.expired()) {
      action();
    }
  });
}

// --- power ---------------------------------------------------------------------------------------

void Mcp2515Chip::reset_pin() {
  start(false);
}

void Mcp2515Chip::power_cycle() {
  start(true);
}

void Mcp2515Chip::start(bool power_on) {
  era_ = std::make_shared<char>();
  ++events_.resets;
  bus_.leave(controller_);
  controller_.set_mode(Controller::Mode::off);
  controller_.reset_error_counters();
  error_bits_ = 0;
  on_wire_ = -1;
  mode_ = OperationMode::configuration;
  entering_.reset();
  // What is left of the SPI instruction goes nowhere: the chip listens again when chip select
  // falls.
  selected_ = false;
  instruction_ = {};
  reset_registers(power_on);
  update_pins();
  start_oscillator(power_on ? options_.crystal_start : SimTime(0));
}

// Filters and buffers have no reset value: they hold anything at power-on, and a reset leaves them
// alone. Masks are 0.
void Mcp2515Chip::reset_registers(bool power_on) {
  std::mt19937 generator(options_.power_on_seed);
  for (std::uint8_t address = 0; address < map::register_count; ++address) {
    if (!map::has_no_reset_value(address)) {
      registers_.at(address) = 0;
    } else if (power_on) {
      registers_.at(address) = static_cast<std::uint8_t>(generator() & map::existing(address));
    }
  }
  registers_[map::canctrl] = map::canctrl_after_reset;
}

void Mcp2515Chip::start_oscillator(SimTime crystal_start) {
  running_ = false;
  later(crystal_start + cycles(start_up_clocks, options_.osc_hz), [this] { oscillator_runs(); });
}

void Mcp2515Chip::oscillator_runs() {
  running_ = true;
  if (mode_ == OperationMode::sleep) {
    // Awake, and silent until told otherwise (10.2).
    constexpr auto awake = OperationMode::listen_only;
    registers_[map::canctrl] = static_cast<std::uint8_t>(
        (registers_[map::canctrl] & 0x1F) | static_cast<int>(awake) << map::reqop_shift);
    mode_ = awake;
    listen();
  }
}

// --- modes ---------------------------------------------------------------------------------------

void Mcp2515Chip::request_mode(std::uint8_t request) {
  if (!is_mode(request)) {
    return violation("REQOP " + std::to_string(request) + " is no mode");
  }
  if (mode_ == OperationMode::sleep && static_cast<OperationMode>(request) != mode_) {
    return violation("a new mode is requested of a chip that sleeps");
  }
  update_mode();
}

// A new mode is entered once no message is pending any more (10), nor on the wire after its TXREQ
// was cleared. A frame that is being received is let go.
bool Mcp2515Chip::may_change_mode() const {
  if (!running_ || mode_ == OperationMode::sleep) {
    return false;
  }
  if (mode_ != OperationMode::normal && mode_ != OperationMode::loopback) {
    return true;
  }
  return on_wire_ < 0 && next_buffer() < 0;
}

void Mcp2515Chip::update_mode() {
  const auto request = static_cast<std::uint8_t>(registers_[map::canctrl] >> map::reqop_shift);
  if (is_mode(request) && static_cast<OperationMode>(request) != entering_.value_or(mode_) &&
      may_change_mode()) {
    enter_mode(static_cast<OperationMode>(request));
  }
}

// Modes that take part in the bus are entered when it has been idle for 11 bits; until then CANSTAT
// shows the mode before.
void Mcp2515Chip::enter_mode(OperationMode mode) {
  entering_.reset();
  if (mode_ == OperationMode::configuration) {
    apply_bit_timing();
  }
  switch (mode) {
    case OperationMode::normal:
      entering_ = mode;
      controller_.set_mode(Controller::Mode::normal);
      controller_.request();
      return;
    case OperationMode::listen_only:
      entering_ = mode;
      listen();
      controller_.request();
      return;
    case OperationMode::sleep:
      controller_.set_mode(Controller::Mode::asleep);
      mode_ = mode;
      return;
    case OperationMode::loopback:
      controller_.set_mode(Controller::Mode::off);
      mode_ = mode;
      return start_loopback();
    case OperationMode::configuration:
      controller_.set_mode(Controller::Mode::off);
      forget_errors();  // (10.1)
      bus_.leave(controller_);
      mode_ = mode;
      return;
  }
}

// The error counters are reset, and stand still (10.3).
void Mcp2515Chip::listen() {
  forget_errors();
  controller_.set_mode(Controller::Mode::listen_only);
}

void Mcp2515Chip::forget_errors() {
  controller_.reset_error_counters();
  on_confinement_changed();
}

void Mcp2515Chip::on_integrated() {
  mode_ = entering_.value_or(mode_);
  entering_.reset();
}

void Mcp2515Chip::on_bus_activity() {
  if ((registers_[map::caninte] & map::wakif) != 0 && running_) {
    set_flag(map::wakif);
    wake_up();
  }
}

// WAKIF wakes the chip, whether the bus or software has set it; WAKIE has to be set as well.
void Mcp2515Chip::wake_up() {
  if (mode_ == OperationMode::sleep && running_) {
    start_oscillator(options_.crystal_start);
  }
}

}  // namespace roio::sim
