// Power, modes, registers and pins. SPI, transmission and reception are in files of their own.
#include <algorithm>
#include <random>
#include <roio/sim/mcp2515_chip.hpp>
#include <utility>

#include "mcp2515_map.hpp"

namespace roio::sim {
namespace {

constexpr std::int64_t start_up_clocks = 128;  // oscillator start-up timer (8.1)
constexpr unsigned warning_limit = 96;
constexpr unsigned passive_limit = 128;
constexpr std::uint8_t information_processing_time = 2;  // quanta, the least that PS2 can be (5.1)

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
  ++era_;
  bus_.leave(controller_);
}

void Mcp2515Chip::violation(std::string what) {
  violations_.push_back({bus_.now(), std::move(what)});
}

// --- power
// ----------------------------------------------------------------------------------------------

void Mcp2515Chip::reset_pin() {
  start(false);
}

void Mcp2515Chip::power_cycle() {
  start(true);
}

void Mcp2515Chip::start(bool power_on) {
  ++era_;
  ++events_.resets;
  bus_.leave(controller_);
  controller_.set_mode(Controller::Mode::off);
  controller_.reset_error_counters();
  error_bits_ = 0;
  on_wire_ = -1;
  loopback_under_way_ = false;
  mode_ = OperationMode::configuration;
  entering_.reset();
  running_ = false;
  std::mt19937 generator(options_.power_on_seed);
  for (std::uint8_t address = 0; address < map::register_count; ++address) {
    const bool in_buffer = address >= map::transmit_control(0) && (address & 0x0F) != 0;
    if (!map::is_filter_or_mask(address) && !in_buffer) {
      registers_.at(address) = 0;
    } else if (power_on) {
      // Bits that do not exist read as 0.
      const bool received = address >= map::receive_control(0);
      const std::uint8_t existing = received ? 0xFF : map::access(address).writable;
      registers_.at(address) = static_cast<std::uint8_t>(generator() & existing);
    }
  }
  registers_[map::canctrl] = map::canctrl_after_reset;
  update_pins();
  const SimTime start_up =
      cycles(start_up_clocks, options_.osc_hz) + (power_on ? options_.crystal_start : SimTime(0));
  bus_.after(start_up, [this, era = era_] {
    if (era == era_) {
      oscillator_runs();
    }
  });
}

void Mcp2515Chip::oscillator_runs() {
  running_ = true;
  if (mode_ == OperationMode::sleep) {
    // Awake, and silent until told otherwise (10.2).
    registers_[map::canctrl] = static_cast<std::uint8_t>(
        (registers_[map::canctrl] & 0x1F) |
        (static_cast<int>(OperationMode::listen_only) << map::reqop_shift));
    enter_mode(OperationMode::listen_only);
  }
}

// --- modes
// ------------------------------------------------------------------------------------------------

void Mcp2515Chip::request_mode(std::uint8_t request) {
  if (request > static_cast<std::uint8_t>(OperationMode::configuration)) {
    violation("REQOP " + std::to_string(request) + " is no mode");
    return;
  }
  update_mode();
}

// A new mode is entered once no message is pending any more (10), and not in the middle of a frame.
bool Mcp2515Chip::may_change_mode() const {
  if (mode_ != OperationMode::normal && mode_ != OperationMode::loopback) {
    return true;
  }
  for (int buffer = 0; buffer < 3; ++buffer) {
    if (is_pending(buffer)) {
      return false;
    }
  }
  return !controller_.transmitting();
}

void Mcp2515Chip::update_mode() {
  const auto wanted = static_cast<std::uint8_t>(registers_[map::canctrl] >> map::reqop_shift);
  if (running_ && wanted <= static_cast<std::uint8_t>(OperationMode::configuration) &&
      static_cast<OperationMode>(wanted) != entering_.value_or(mode_) && may_change_mode()) {
    enter_mode(static_cast<OperationMode>(wanted));
  }
}

// Modes that take part in the bus are entered when it has been idle for 11 bits; until then CANSTAT
// shows the mode before.
void Mcp2515Chip::enter_mode(OperationMode mode) {
  ++era_;
  loopback_under_way_ = false;
  entering_.reset();
  if (mode_ == OperationMode::configuration) {
    apply_bit_timing();
  }
  switch (mode) {
    case OperationMode::normal:
    case OperationMode::listen_only:
      entering_ = mode;
      controller_.set_mode(mode == OperationMode::normal ? Controller::Mode::normal
                                                         : Controller::Mode::listen_only);
      controller_.request();
      return;
    case OperationMode::sleep:
      controller_.set_mode(Controller::Mode::asleep);
      break;
    case OperationMode::loopback:
      controller_.set_mode(Controller::Mode::off);
      break;
    case OperationMode::configuration:
      controller_.set_mode(Controller::Mode::off);
      controller_.reset_error_counters();  // (10.1)
      on_confinement_changed();
      bus_.leave(controller_);
      break;
  }
  mode_ = mode;
  if (mode == OperationMode::loopback) {
    start_loopback();
  }
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

void Mcp2515Chip::wake_up() {
  if (mode_ != OperationMode::sleep || !running_) {
    return;
  }
  running_ = false;
  const SimTime start_up = cycles(start_up_clocks, options_.osc_hz) + options_.crystal_start;
  bus_.after(start_up, [this, era = era_] {
    if (era == era_) {
      oscillator_runs();
    }
  });
}

// --- bit timing (5)
// ---------------------------------------------------------------------------------------

SimTime Mcp2515Chip::quantum() const {
  return cycles(2 * ((registers_[map::cnf1] & 0x3F) + 1), options_.osc_hz);
}

namespace {

struct Segments {
  int propagation;
  int phase1;
  int phase2;
  int jump;
};

Segments segments_of(std::uint8_t cnf1, std::uint8_t cnf2, std::uint8_t cnf3) {
  const int phase1 = ((cnf2 >> 3) & 7) + 1;
  const bool phase2_is_set = (cnf2 & map::btlmode) != 0;
  return {(cnf2 & 7) + 1, phase1,
          phase2_is_set ? (cnf3 & 7) + 1 : std::max<int>(phase1, information_processing_time),
          (cnf1 >> 6) + 1};
}

}  // namespace

std::uint8_t Mcp2515Chip::quanta_per_bit() const {
  const Segments s =
      segments_of(registers_[map::cnf1], registers_[map::cnf2], registers_[map::cnf3]);
  return static_cast<std::uint8_t>(1 + s.propagation + s.phase1 + s.phase2);
}

bool Mcp2515Chip::timing_is_valid() const {
  const Segments s =
      segments_of(registers_[map::cnf1], registers_[map::cnf2], registers_[map::cnf3]);
  return s.propagation + s.phase1 >= s.phase2 && s.phase2 >= information_processing_time &&
         s.phase2 > s.jump;
}

NodeTiming Mcp2515Chip::timing() const {
  const Segments s =
      segments_of(registers_[map::cnf1], registers_[map::cnf2], registers_[map::cnf3]);
  const std::int64_t clocks = 2 * ((registers_[map::cnf1] & 0x3F) + 1);
  return {cycles(clocks * quanta_per_bit(), options_.osc_hz),
          cycles(clocks * (1 + s.propagation + s.phase1), options_.osc_hz), quantum() * s.jump};
}

std::uint32_t Mcp2515Chip::bitrate_bps() const {
  const auto clocks =
      static_cast<std::uint32_t>(2 * ((registers_[map::cnf1] & 0x3F) + 1) * quanta_per_bit());
  return timing_is_valid() ? options_.osc_hz / clocks : 0;
}

void Mcp2515Chip::apply_bit_timing() {
  if (!timing_is_valid()) {
    violation("CNF1..3 break the rules for bit timing");
  }
  bus_.join(controller_, timing());
}

// --- registers
// ----------------------------------------------------------------------------------------------

bool Mcp2515Chip::is_readable_now(std::uint8_t address) const {
  // Filters and masks read as 0 outside configuration mode (4.5).
  return mode_ == OperationMode::configuration || !map::is_filter_or_mask(address);
}

std::uint8_t Mcp2515Chip::peek(std::uint8_t address) const {
  if (map::is_canstat(address)) {
    return status_register();
  }
  if (map::is_canctrl(address)) {
    return registers_[map::canctrl];
  }
  switch (address) {
    case map::tec:
      return static_cast<std::uint8_t>(std::min(controller_.transmit_errors(), 255U));
    case map::rec:
      return static_cast<std::uint8_t>(std::min(controller_.receive_errors(), 255U));
    case map::eflg:
      return static_cast<std::uint8_t>(registers_[map::eflg] | error_bits_);
    case map::txrtsctrl: {
      std::uint8_t value = registers_[map::txrtsctrl];
      for (unsigned pin = 0; pin < 3; ++pin) {
        // A pin in request mode reads as 0.
        if (((value >> pin) & 1U) == 0 && rts_pins_.at(pin)) {
          value = static_cast<std::uint8_t>(value | 8U << pin);
        }
      }
      return value;
    }
    default:
      return registers_.at(address);
  }
}

std::uint8_t Mcp2515Chip::read_register(std::uint8_t address) const {
  return is_readable_now(address) ? peek(address) : 0;
}

std::uint8_t Mcp2515Chip::status_register() const {
  return static_cast<std::uint8_t>((static_cast<int>(mode_) << map::reqop_shift) |
                                   (interrupt_code() << 1));
}

// The highest enabled interrupt (7.7): error, wake-up, TXB0, TXB1, TXB2, RXB0, RXB1.
std::uint8_t Mcp2515Chip::interrupt_code() const {
  constexpr std::array<std::uint8_t, 7> order{
      map::errif, map::wakif, map::txif(0), map::txif(1), map::txif(2), map::rxif(0), map::rxif(1)};
  const std::uint8_t pending = registers_[map::canintf] & registers_[map::caninte];
  const auto* const first = std::find_if(
      order.begin(), order.end(), [pending](std::uint8_t flag) { return (pending & flag) != 0; });
  return first == order.end() ? 0 : static_cast<std::uint8_t>(first - order.begin() + 1);
}

void Mcp2515Chip::write_register(std::uint8_t address, std::uint8_t value, std::uint8_t mask) {
  const map::Access access = map::access(address);
  if (access.writable == 0) {
    return violation("write to read-only register " + std::to_string(address));
  }
  if (access.configuration_only && mode_ != OperationMode::configuration) {
    return violation("write to register " + std::to_string(address) +
                     " outside configuration mode");
  }
  const bool in_transmit_buffer = address > map::transmit_control(0) &&
                                  address < map::receive_control(0) && (address & 0x0F) != 0;
  if (in_transmit_buffer && (registers_.at(address & 0xF0U) & map::txreq) != 0) {
    violation("write to transmit buffer " + std::to_string((address >> 4) - 3) +
              " while its transmission is pending");
  }
  std::uint8_t& target = registers_.at(map::is_canctrl(address) ? map::canctrl : address);
  const std::uint8_t before = target;
  const auto changed = static_cast<std::uint8_t>(access.writable & mask);
  target = static_cast<std::uint8_t>((before & ~changed) | (value & changed));
  register_written(address, before);
}

void Mcp2515Chip::modify_register(std::uint8_t address, std::uint8_t value, std::uint8_t mask) {
  if (!map::access(address).bit_modify) {
    violation("BIT MODIFY of register " + std::to_string(address) + ", which takes no mask");
    mask = 0xFF;
  }
  write_register(address, value, mask);
}

void Mcp2515Chip::register_written(std::uint8_t address, std::uint8_t before) {
  if (map::is_canctrl(address)) {
    if ((registers_[map::canctrl] & ~before & map::abat) != 0) {
      abort_all();
    }
    return request_mode(static_cast<std::uint8_t>(registers_[map::canctrl] >> map::reqop_shift));
  }
  for (int buffer = 0; buffer < 3; ++buffer) {
    if (address == map::transmit_control(buffer)) {
      const std::uint8_t now = registers_.at(address);
      registers_.at(address) =
          static_cast<std::uint8_t>((now & ~map::txreq) | (before & map::txreq));
      if ((now & ~before & map::txreq) != 0) {
        request_transmission(buffer);
      } else if ((before & ~now & map::txreq) != 0) {
        take_back(buffer);
      }
    }
  }
  if (address == map::receive_control(0)) {
    // BUKT1 is a read-only copy of BUKT.
    const auto control = static_cast<std::uint8_t>(registers_.at(address) & ~map::bukt1);
    registers_.at(address) =
        static_cast<std::uint8_t>(control | ((control & map::bukt) != 0 ? map::bukt1 : 0));
  }
  if ((address == map::receive_control(0) || address == map::receive_control(1))) {
    const std::uint8_t rxm = registers_.at(address) & map::rxm;
    if (rxm != 0 && rxm != map::rxm) {
      violation("RXM 01 and 10 are reserved");
    }
  }
  if (address == map::canintf && (registers_[map::canintf] & ~before & map::wakif) != 0) {
    wake_up();
  }
  update_pins();
}

void Mcp2515Chip::set_flag(std::uint8_t flag) {
  registers_[map::canintf] |= flag;
  update_pins();
}

// --- pins
// ---------------------------------------------------------------------------------------------------

bool Mcp2515Chip::interrupt_pin() const {
  return (registers_[map::canintf] & registers_[map::caninte]) == 0;
}

void Mcp2515Chip::update_pins() {
  const bool pin = interrupt_pin();
  if (pin != pin_) {
    pin_ = pin;
    if (pin_listener_) {
      pin_listener_(pin);
    }
  }
}

std::optional<bool> Mcp2515Chip::receive_buffer_pin(int buffer) const {
  const std::uint8_t control = registers_[map::bfpctrl];
  const bool enabled = ((control >> (2 + buffer)) & 1) != 0;
  if (!enabled) {
    return std::nullopt;
  }
  const bool shows_buffer = ((control >> buffer) & 1) != 0;
  return shows_buffer ? (registers_[map::canintf] & map::rxif(buffer)) == 0
                      : ((control >> (4 + buffer)) & 1) != 0;
}

void Mcp2515Chip::set_request_to_send_pin(int buffer, bool level) {
  const auto index = static_cast<std::size_t>(buffer);
  const bool falls = rts_pins_.at(index) && !level;
  rts_pins_.at(index) = level;
  if (falls && ((registers_[map::txrtsctrl] >> buffer) & 1) != 0) {
    request_transmission(buffer);
  }
}

// --- errors (6)
// ---------------------------------------------------------------------------------------------

void Mcp2515Chip::on_confinement_changed() {
  const unsigned transmit = controller_.transmit_errors();
  const unsigned receive = controller_.receive_errors();
  const bool bus_off = controller_.confinement() == Confinement::bus_off;
  std::uint8_t bits = 0;
  bits |= bus_off ? map::txbo : 0;
  bits |= transmit >= passive_limit ? map::txep : 0;
  bits |= receive >= passive_limit ? map::rxep : 0;
  bits |= transmit >= warning_limit ? map::txwar : 0;
  bits |= receive >= warning_limit ? map::rxwar : 0;
  bits |= (bits & (map::txwar | map::rxwar)) != 0 ? map::ewarn : 0;
  const auto risen = static_cast<std::uint8_t>(bits & ~error_bits_);
  events_.bus_offs += (risen & map::txbo) != 0 ? 1 : 0;
  error_bits_ = bits;
  if (risen != 0) {
    set_flag(map::errif);
  }
}

void Mcp2515Chip::on_receive_error(BusError /*error*/) {
  set_flag(map::merrf);
}

}  // namespace roio::sim
