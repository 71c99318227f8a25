#include "panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "form/record_format.hpp"

namespace roio::sim_tool {
namespace {

using namespace std::chrono_literals;

// Shorter is no level to a person, but a servo's pulse, or a wire that something else is on.
constexpr sim::SimTime shortest_level = 10ms;
constexpr sim::SimTime shortest_pulse = 450us;
constexpr sim::SimTime longest_pulse = 2600us;
constexpr sim::SimTime shortest_period = 12ms;
constexpr sim::SimTime longest_period = 30ms;
constexpr sim::SimTime between_servo_lines = 100ms;
constexpr double servo_play_degrees = 0.75;  // so that one between two degrees does not flicker
constexpr sim::SimTime press_time = 100ms;
constexpr sim::SimTime unfinished_line_time = 200ms;
constexpr std::size_t longest_line = 1024;
constexpr std::size_t most_kinds = 10;  // of what hardware does not put up with

// Arduino's numbers of SS, MOSI, MISO and SCK.
std::set<int> spi_pins(sim::BoardKind kind) {
  switch (kind) {
    case sim::BoardKind::uno:
      return {10, 11, 12, 13};
    case sim::BoardKind::leonardo:
      return {14, 15, 16, 17};
    case sim::BoardKind::mega:
      break;
  }
  return {50, 51, 52, 53};
}

int mosi_pin(sim::BoardKind kind) {
  switch (kind) {
    case sim::BoardKind::uno:
      return 11;
    case sim::BoardKind::leonardo:
      return 16;
    case sim::BoardKind::mega:
      break;
  }
  return 51;
}

sim::BoardOptions board_options(const BoardWish& wish) {
  sim::BoardOptions options = wish.options;
  options.name = wish.name;
  return options;
}

const char* mode_name(sim::Mcp2515Chip::OperationMode mode) {
  using Mode = sim::Mcp2515Chip::OperationMode;
  switch (mode) {
    case Mode::normal:
      return "normal";
    case Mode::sleep:
      return "asleep";
    case Mode::loopback:
      return "loopback";
    case Mode::listen_only:
      return "listen-only";
    case Mode::configuration:
      break;
  }
  return "configuration";
}

}  // namespace

Panel::Panel(sim::CanBus& bus, const BoardWish& wish, std::uint32_t bitrate_bps, Report& report)
    : bus_(bus),
      bitrate_bps_(bitrate_bps),
      report_(report),
      board_(bus, wish.kind, wish.elf, board_options(wish)),
      select_pin_(sim::main_pin(wish.kind, wish.options.chip_select_pin)),
      state_(can_state()),
      state_shown_(state_) {
  if (wish.options.interrupt_pin) {
    interrupt_pin_ = sim::main_pin(wish.kind, *wish.options.interrupt_pin);
  }
  watch_pins(wish);
  watch_serial(wish);
}

void Panel::watch_pins(const BoardWish& wish) {
  std::set<int> busy = spi_pins(wish.kind);
  busy.insert(select_pin_);
  for (int number = 0; number < board_.pins(); ++number) {
    const bool is_other_number = sim::main_pin(wish.kind, number) != number;
    if (!is_other_number && !busy.contains(number)) {
      pins_[number] = {};
      board_.on_pin(number, [this, number](sim::SimTime time, bool high) {
        pin_changed(number, time, high);
      });
    }
  }
}

void Panel::watch_serial(const BoardWish& wish) {
  for (int port = 0; port < board_.serial_ports(); ++port) {
    if (port == 0 && wish.has_terminal) {
      terminal_link_ = wish.terminal_link;
      terminal_ = std::make_unique<sim::SerialPty>(bus_, board_, port,
                                                   sim::SerialPtyOptions{.link = terminal_link_});
      show_terminal();
    } else {
      board_.on_serial(port, [this, port](std::uint8_t byte) { serial_byte(port, byte); });
    }
  }
}

// Under the name that programs are to use.
void Panel::show_terminal() {
  const bool has_link = terminal_->is_plugged() && !terminal_link_.empty();
  report_.terminal(bus_.now(), name(), has_link ? terminal_link_ : terminal_->path());
}

// --- what it shows -------------------------------------------------------------------------------

void Panel::pin_changed(int number, sim::SimTime time, bool high) {
  Pin& pin = pins_[number];
  if (high) {
    pin.is_regular =
        pin.rise && time - *pin.rise >= shortest_period && time - *pin.rise <= longest_period;
    pin.rise = time;
  } else if (pin.rise) {
    pulse_ended(pin, time - *pin.rise);
  }
  pin.high = high;
  pin.changed = time;
}

void Panel::pulse_ended(Pin& pin, sim::SimTime width) {
  if (!pin.is_regular || width < shortest_pulse || width > longest_pulse) {
    pin.pulses = 0;
    return;
  }
  const double angle = sim::servo_angle(width);
  if (++pin.pulses >= 2 && (!pin.degrees || std::abs(angle - *pin.degrees) > servo_play_degrees)) {
    pin.degrees = static_cast<int>(std::lround(angle));
  }
}

void Panel::look() {
  for (auto& [number, pin] : pins_) {
    look_at_pin(number, pin);
  }
  for (auto& [uart, line] : lines_) {
    if (!line.text.empty() && bus_.now() - line.last >= unfinished_line_time) {
      end_line(uart, line);
    }
  }
  look_outside();
  look_at_chip();
}

// A sketch may set its pins after the command came.
void Panel::look_outside() {
  for (auto& [number, outside] : outside_) {
    if (!outside.is_told && board_.pin(number)) {
      outside.is_told = true;
      note(name() + ": pin " + pin_name(number) + ": the sketch drives this pin, so that " +
           outside.what + " from outside changes nothing");
    }
  }
}

void Panel::look_at_pin(int number, Pin& pin) {
  const sim::SimTime now = bus_.now();
  if (pin.high != pin.shown && now - pin.changed >= shortest_level) {
    pin.shown = pin.high;
    report_.pin(now, name(), pin_name(number), pin.high);
  }
  if (pin.degrees != pin.degrees_shown &&
      (!pin.degrees_shown || now - pin.degrees_time >= between_servo_lines)) {
    pin.degrees_shown = pin.degrees;
    pin.degrees_time = now;
    report_.servo(now, name(), pin_name(number), *pin.degrees);
  }
}

void Panel::serial_byte(int uart, std::uint8_t byte) {
  Line& line = lines_[uart];
  line.last = bus_.now();
  if (byte == '\n') {
    end_line(uart, line);
  } else if (byte != '\r') {
    line.text.push_back(static_cast<char>(byte));
    if (line.text.size() >= longest_line) {
      end_line(uart, line);
    }
  }
}

void Panel::end_line(int uart, Line& line) {
  report_.serial(line.last, name(), uart, line.text);
  line.text.clear();
}

Panel::CanState Panel::can_state() {
  sim::Mcp2515Chip& chip = board_.chip();
  switch (chip.controller().confinement()) {
    case sim::Confinement::passive:
      return {"error-passive", chip.bitrate_bps()};
    case sim::Confinement::bus_off:
      return {"bus-off", chip.bitrate_bps()};
    case sim::Confinement::active:
      break;
  }
  const bool takes_part = chip.mode() == sim::Mcp2515Chip::OperationMode::normal ||
                          chip.mode() == sim::Mcp2515Chip::OperationMode::listen_only;
  return {mode_name(chip.mode()), takes_part ? chip.bitrate_bps() : 0};
}

// Not of its own frames, off the bus: a program that measures the crystal lets them fall.
void Panel::count_overflows() {
  const std::uint64_t overflowed = board_.chip().events().overflowed;
  const bool is_in_loopback = board_.chip().mode() == sim::Mcp2515Chip::OperationMode::loopback;
  if (!is_in_loopback && !was_in_loopback_) {
    overflows_ += overflowed - overflows_seen_;
  }
  overflows_seen_ = overflowed;
  was_in_loopback_ = is_in_loopback;
}

void Panel::look_at_chip() {
  count_overflows();
  const CanState state = can_state();
  if (state != state_) {
    state_ = state;
    state_since_ = bus_.now();
  }
  if (state_ == state_shown_ || bus_.now() - state_since_ < shortest_level) {
    return;
  }
  state_shown_ = state_;
  report_.can(bus_.now(), name(), state_.name, state_.bitrate_bps);
  if (state_.bitrate_bps != 0 && state_.bitrate_bps / 1000 != bitrate_bps_ / 1000 &&
      std::exchange(other_bitrate_bps_, state_.bitrate_bps) != state_.bitrate_bps) {
    note(name() + ": its chip is set to " + std::to_string(state_.bitrate_bps) +
         " bit/s, the bus runs at " + std::to_string(bitrate_bps_) +
         " (see --rate, and --crystal)");
  }
}

void Panel::finish() {
  look();
  for (auto& [uart, line] : lines_) {
    if (!line.text.empty()) {
      end_line(uart, line);
    }
  }
  if (overflows_ > 0) {
    note(name() + ": " + cli::count_of(overflows_, "frame") +
         " lost: the chip's buffers were full");
  }
  if (terminal_) {
    tell_lost_bytes();
  }
  tell_unused_chip();
  tell_violations();
}

// Of a sketch that has another pin in mind nothing else is to be seen.
void Panel::tell_unused_chip() {
  if (board_.pin(mosi_pin(board_.kind())) && !board_.pin(select_pin_)) {
    note(name() + ": its sketch uses SPI, but not pin " + pin_name(select_pin_) +
         ", where the chip's select is; see --cs");
  }
}

// Each kind once, with how often it was.
void Panel::tell_violations() {
  const sim::Mcp2515Chip& chip = board_.chip();
  std::vector<std::pair<std::string, std::uint64_t>> kinds;
  std::uint64_t rest = chip.violation_count() - chip.violations().size();
  for (const auto* violations : {&board_.violations(), &chip.violations()}) {
    for (const sim::Mcp2515Violation& violation : *violations) {
      const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) {
        return kind.first == violation.what;
      });
      if (found != kinds.end()) {
        found->second += violation.times;
      } else if (kinds.size() < most_kinds) {
        kinds.emplace_back(violation.what, violation.times);
      } else {
        rest += violation.times;
      }
    }
  }
  for (const auto& [what, times] : kinds) {
    note(name() + ": the hardware does not put up with this: " + what +
         (times > 1 ? " (" + std::to_string(times) + " times)" : ""));
  }
  if (rest > 0) {
    note(name() + ": and " + cli::count_of(rest, "thing") + " more of that sort");
  }
}

void Panel::tell_lost_bytes() {
  const auto tell = [this](std::uint64_t count, const char* what) {
    if (count > 0) {
      note(name() + ": " + cli::count_of(count, "byte") + what);
    }
  };
  tell(terminal_->lost(), " lost: nobody read its serial port");
  tell(terminal_->unheard(), " lost: its serial port was unplugged");
  tell(terminal_->garbled_by_wrong_rate(),
       " garbled: its serial port was set to another rate than the board's");
}

// --- what can be done to it ----------------------------------------------------------------------

std::string Panel::pin_name(int number) const {
  return sim::pin_name(board_.kind(), number);
}

int Panel::number_of(const PinName& pin) const {
  return sim_tool::number_of(board_.kind(), pin);
}

int Panel::number_to_drive(const PinName& pin) const {
  const int number = number_of(pin);
  if (number == interrupt_pin_) {
    throw std::invalid_argument(name() + ": pin " + pin_name(number) +
                                " is driven by the chip, whose INT is there; see --int");
  }
  return number;
}

void Panel::check(const Action& action) const {
  if (const auto* const press = std::get_if<Press>(&action)) {
    static_cast<void>(number_to_drive(press->pin));
  } else if (const auto* const set = std::get_if<SetPin>(&action)) {
    static_cast<void>(number_to_drive(set->pin));
  } else if (const auto* const analog = std::get_if<SetAnalog>(&action)) {
    static_cast<void>(board_.analog_pin(analog->channel));
  } else if (const auto* const serial = std::get_if<Serial>(&action)) {
    static_cast<void>(board_.serial_waiting(serial->uart));
  } else if (const auto* const plug = std::get_if<Plug>(&action);
             plug != nullptr && plug->cable == Cable::terminal && !terminal_) {
    throw std::invalid_argument(name() + ": its serial port is no terminal; see --serial-pty");
  }
}

void Panel::apply(const Action& action) {
  check(action);
  std::visit([this](const auto& what) { do_action(what); }, action);
}

void Panel::do_action(const Press& press) {
  const int number = number_of(press.pin);
  board_.set_pin(number, false);
  outside_[number] = {"low"};
  bus_.after(press_time, [this, number] {
    board_.release_pin(number);
    outside_.erase(number);
  });
}

void Panel::do_action(const SetPin& set) {
  const int number = number_of(set.pin);
  if (set.high) {
    board_.set_pin(number, *set.high);
    outside_[number] = {*set.high ? "high" : "low"};
  } else {
    board_.release_pin(number);
    outside_.erase(number);
  }
}

void Panel::do_action(const SetAnalog& set) {
  board_.set_analog(set.channel, set.volts);
  outside_[number_of({true, set.channel})] = {fmt::format("{:.2f} V", set.volts)};
}

void Panel::do_action(const Serial& serial) {
  const std::string line = serial.text + '\n';
  const std::vector<std::uint8_t> bytes(line.begin(), line.end());
  board_.serial_write(serial.uart, bytes);
}

void Panel::do_action(const Reset& /*reset*/) {
  board_.reset();
}

void Panel::do_action(const Plug& plug) {
  if (plug.cable == Cable::terminal) {
    plug_terminal(plug.in);
  } else {
    board_.set_chip_fault(plug.in ? sim::SpiWire::Fault::none : sim::SpiWire::Fault::stuck_high);
  }
}

void Panel::plug_terminal(bool in) {
  if (in == terminal_->is_plugged()) {
    return;
  }
  try {
    if (in) {
      terminal_->plug();
    } else {
      terminal_->unplug();
    }
  } catch (const std::system_error& error) {
    throw std::invalid_argument(name() + ": " + error.what());
  }
  show_terminal();
}

}  // namespace roio::sim_tool
