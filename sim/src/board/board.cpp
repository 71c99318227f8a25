#include <algorithm>
#include <array>
#include <optional>
#include <roio/sim/board.hpp>
#include <utility>

#include "avr/adc.hpp"
#include "avr/board_model.hpp"
#include "avr/core.hpp"
#include "avr/external_interrupts.hpp"
#include "avr/image.hpp"
#include "avr/ports.hpp"
#include "avr/spi.hpp"
#include "avr/uart.hpp"
#include "avr/usb_serial.hpp"
#include "board/wiring.hpp"

namespace roio::sim {
namespace {

using Cycle = AvrCore::Cycle;

constexpr SimTime cycle_time = cycles(1, AvrCore::clock_hz);
static_assert(cycle_time * AvrCore::clock_hz == std::chrono::seconds(1));

// What a chip sends on an idle bus reaches no other chip's interrupt line for as long: at 1 Mbit/s,
// a frame has 44 bits at least. (Only a chip asleep notices the first.)
constexpr SimTime silence = std::chrono::microseconds(20);
constexpr std::uint8_t nothing_there = 0xFF;
constexpr double zero_degrees_us = 544;
constexpr double half_turn_us = 2400;
constexpr double half_turn = 180;

std::string name_of(BoardKind kind, const std::filesystem::path& elf, const BoardOptions& options) {
  return options.name.empty() ? std::string(to_string(kind)) + " (" + elf.filename().string() + ")"
                              : options.name;
}

AvrImage image_for(const BoardModel& model, const std::filesystem::path& elf) {
  AvrImage image = read_avr_image(elf);
  const std::string board = std::string("a ") + model.name + " has an " + model.mcu;
  if (!image.mcu.empty() && image.mcu != model.mcu) {
    throw std::runtime_error(elf.string() + ": is for an " + image.mcu + ", but " + board);
  }
  if (image.architecture != model.architecture) {
    throw std::runtime_error(elf.string() + ": is for another family of AVR (avr" +
                             std::to_string(image.architecture) + "), but " + board + " (avr" +
                             std::to_string(model.architecture) + ")");
  }
  if (image.flash.size() > model.flash_bytes) {
    throw std::runtime_error(elf.string() + ": is too big: " + std::to_string(image.flash.size()) +
                             " bytes of flash, but " + board + " with " +
                             std::to_string(model.flash_bytes));
  }
  return image;
}

}  // namespace

// The AVR, what is around it, and how it keeps in step with the bus.
class Board::Machine : public CanBus::Companion,
                       public std::enable_shared_from_this<Board::Machine> {
 public:
  Machine(CanBus& bus, BoardKind kind, const std::filesystem::path& elf,
          const BoardOptions& options);
  ~Machine() override { bus_.detach(*this); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  void step() override;
  void reset();
  /// Somebody listens: what the board does may act on others at once.
  void listened_to() { reach = SimTime(0); }

  struct Pin {
    AvrPorts::Level level;
    std::optional<Cycle> rise;
    std::optional<Cycle> pulse;
    std::function<void(SimTime, bool)> listener;
  };

  [[nodiscard]] SimTime time_of(Cycle cycle) const {
    return origin_ + static_cast<std::int64_t>(cycle) * cycle_time;
  }
  [[nodiscard]] SimTime now() const { return time_of(core.cycle()); }
  [[nodiscard]] const BoardModel& model() const { return model_; }
  [[nodiscard]] McuPin mcu_pin(int pin) const;
  [[nodiscard]] Pin& pin(int pin) { return pins_[index_of(mcu_pin(pin))]; }
  [[nodiscard]] std::size_t index_of(McuPin pin) const;
  [[nodiscard]] AvrSerial& serial(int number) { return *serial_slot(number).line; }
  [[nodiscard]] unsigned adc_channel(int channel) const;
  void set_chip_fault(SpiWire::Fault fault);
  /// From outside; none: no longer.
  void drive(int pin, std::optional<bool> level);

  std::string name;
  AvrCore core;
  AvrPorts ports;
  AvrExternalInterrupts interrupts;
  AvrSpi spi;
  AvrAdc adc;
  std::optional<Mcp2515Chip> chip;
  std::uint64_t resets = 0;
  std::vector<Mcp2515Violation> violations;
  std::function<void(SimTime, std::uint8_t, std::uint8_t)> spi_listener;
  struct Serial {
    int number;
    std::unique_ptr<AvrSerial> line;
    std::function<void(std::uint8_t)> listener;
    std::optional<double> sent_bps;  // of the byte that the listener had last
  };
  [[nodiscard]] Serial& serial_slot(int number);

 private:
  struct Edge {
    Cycle cycle;
    bool selected;
  };

  void add_serial(int number, std::unique_ptr<AvrSerial> line);
  void post(Cycle cycle, std::function<void()> action);
  void tell_trouble();
  [[nodiscard]] std::optional<Cycle> next_contact() const;
  void make_contact();
  void finish_byte();
  void select(bool selected);
  void restarted();
  void pin_changed(McuPin changed, AvrPorts::Level level);
  void interrupt_line(bool high);
  void violation(const char* what);
  [[nodiscard]] Cycle cycle_at(SimTime time) const {
    return static_cast<Cycle>((time - origin_) / cycle_time);
  }

  CanBus& bus_;
  const BoardModel& model_;
  BoardOptions options_;
  SimTime origin_;
  std::vector<Pin> pins_;
  std::vector<Serial> serials_;
  std::optional<Edge> edge_;
  bool selected_ = false;       // as the program has it
  bool chip_selected_ = false;  // as the chip sees it
  SpiWire::Fault fault_ = SpiWire::Fault::none;
  bool dead_ = false;      // and told so
  std::uint64_t era_ = 0;  // since the last restart: what was being sent dies with it
};

Board::Machine::Machine(CanBus& bus, BoardKind kind, const std::filesystem::path& elf,
                        const BoardOptions& options)
    : name(name_of(kind, elf, options)),
      core(model_of(kind), image_for(model_of(kind), elf)),
      ports(core, model_of(kind)),
      interrupts(core, ports, model_of(kind)),
      spi(core),
      adc(core, kind),
      bus_(bus),
      model_(model_of(kind)),
      options_(options),
      origin_(bus.now()),
      pins_(model_.pins.size()) {
  check_wiring(model_, options);
  if (model_.has_usb) {
    auto usb = std::make_unique<UsbSerial>(core);
    usb->on_violation([this](const char* what) { violation(what); });
    add_serial(0, std::move(usb));
  }
  for (const McuUart& made : model_.uarts) {
    add_serial(made.number, std::make_unique<AvrUart>(core, made.base));
  }
  core.on_restart([this] { restarted(); });
  core.on_interrupt([this](const avr_int_vector_t& vector) {
    for (const Serial& slot : serials_) {
      slot.line->interrupt_entered(vector);
    }
    interrupts.update();
  });
  ports.on_change([this](McuPin pin, AvrPorts::Level level) {
    pin_changed(pin, level);
    interrupts.update();
  });
  spi.on_collision([this] { violation("SPDR written while a byte is under way"); });
  spi.set_slave_select([this] {
    return !ports.level(model_.ss) && ports.outside(model_.ss) == std::optional(false);
  });
  if (options.has_chip) {
    chip.emplace(bus, options.chip);
    chip->on_interrupt_pin([this](bool high) { interrupt_line(high); });
    interrupt_line(chip->interrupt_pin());
  }
  reach = silence;
  next = bus.now();
  bus.attach(*this);
}

void Board::Machine::add_serial(int number, std::unique_ptr<AvrSerial> line) {
  line->on_send([this, number](Cycle end, std::uint8_t byte) {
    if (serial_slot(number).listener) {
      const std::optional<double> bitrate_bps = serial(number).bitrate_bps();
      post(end, [this, number, byte, bitrate_bps, era = era_] {
        const auto listener = serial_slot(number).listener;
        if (listener && era == era_) {
          serial_slot(number).sent_bps = bitrate_bps;
          listener(byte);
        }
      });
    }
  });
  serials_.push_back({number, std::move(line), nullptr, std::nullopt});
}

// --- in step with the bus ------------------------------------------------------------------------

// Something that the board does to the outside, at a cycle to come. What comes of it may act on the
// board again, so that this one does not run on for long.
void Board::Machine::post(Cycle cycle, std::function<void()> action) {
  core.limit(cycle + static_cast<Cycle>(options_.lead / cycle_time));
  bus_.at(time_of(cycle), [weak = weak_from_this(), action = std::move(action)] {
    if (const auto self = weak.lock()) {
      action();
    }
  });
}

// The first thing that the AVR does to the chip and that has not happened there yet.
std::optional<Cycle> Board::Machine::next_contact() const {
  const std::optional<Cycle> end = spi.end();
  if (end && *end <= core.cycle()) {
    return edge_ ? std::min(*end, edge_->cycle) : *end;
  }
  return edge_ ? std::optional(edge_->cycle) : std::nullopt;
}

void Board::Machine::make_contact() {
  if (spi.end() && (!edge_ || *spi.end() <= edge_->cycle) && *spi.end() <= core.cycle()) {
    finish_byte();
  } else {
    selected_ = std::exchange(edge_, std::nullopt)->selected;
    select(selected_);
  }
}

void Board::Machine::step() {
  for (;;) {
    if (const std::optional<Cycle> contact = next_contact()) {
      if (time_of(*contact) > bus_.now()) {
        next = time_of(*contact);
        return;
      }
      make_contact();
      continue;
    }
    if (!core.trouble().empty()) {
      return tell_trouble();
    }
    const SimTime target = std::max(bus_.now() + options_.lead, bus_.quiet_until(*this));
    if (now() >= target) {
      next = now();
      return;
    }
    const Cycle cycle = std::max(cycle_at(target), core.cycle() + 1);
    core.run_until(spi.end() ? std::min(cycle, *spi.end()) : cycle);
  }
}

void Board::Machine::tell_trouble() {
  if (now() > bus_.now()) {
    next = now();
    return;
  }
  next.reset();
  dead_ = true;
  throw BoardError(name + " " + core.trouble());
}

void Board::Machine::reset() {
  if (std::exchange(dead_, false)) {
    core.skip_to(cycle_at(bus_.now()) + 1);
    next = bus_.now();
  }
  core.reset();
}

void Board::Machine::restarted() {
  ++resets;
  ++era_;
  spi.reset();
  adc.reset();
  for (const Serial& slot : serials_) {
    slot.line->reset();
  }
  ports.reset();
  interrupts.reset();
}

void Board::Machine::drive(int pin, std::optional<bool> level) {
  if (level) {
    ports.drive(mcu_pin(pin), *level);
  } else {
    ports.release(mcu_pin(pin));
  }
  interrupts.update();
}

// --- the chip ------------------------------------------------------------------------------------

void Board::Machine::select(bool selected) {
  const bool reaches = selected && fault_ == SpiWire::Fault::none;
  if (chip && reaches != std::exchange(chip_selected_, reaches)) {
    if (reaches) {
      chip->select();
    } else {
      chip->deselect();
    }
  }
}

void Board::Machine::finish_byte() {
  const std::uint8_t out = spi.out();
  std::uint8_t in = fault_ == SpiWire::Fault::stuck_low ? 0x00 : nothing_there;
  const bool clock = ports.level(model_.sck).has_value();
  const bool data = ports.level(model_.mosi).has_value();
  const bool mode_fits = spi.mode() == 0 || spi.mode() == 3;
  if (chip_selected_) {
    if (!clock) {
      violation("SCK is not an output");
    } else if (!mode_fits) {
      violation("the chip knows SPI modes 0 and 3 only");
    } else {
      if (!data) {
        violation("MOSI is not an output");
      }
      in = chip->exchange(data ? out : nothing_there);
    }
  }
  spi.finish(in);
  if (spi_listener) {
    bus_.at(bus_.now(), [weak = weak_from_this(), time = bus_.now(), out, in] {
      if (const auto self = weak.lock(); self && self->spi_listener) {
        const auto listener = self->spi_listener;
        listener(time, out, in);
      }
    });
  }
}

void Board::Machine::interrupt_line(bool high) {
  if (options_.interrupt_pin && fault_ == SpiWire::Fault::none) {
    drive(*options_.interrupt_pin, high);
  }
}

void Board::Machine::set_chip_fault(SpiWire::Fault fault) {
  fault_ = fault;
  select(selected_);
  if (!options_.interrupt_pin || !chip) {
    return;
  }
  if (fault == SpiWire::Fault::none) {
    interrupt_line(chip->interrupt_pin());
  } else {
    drive(*options_.interrupt_pin, std::nullopt);
  }
}

void Board::Machine::violation(const char* what) {
  const auto noted = std::find_if(violations.begin(), violations.end(),
                                  [&](const Mcp2515Violation& one) { return one.what == what; });
  if (noted != violations.end()) {
    ++noted->times;
  } else {
    violations.push_back({time_of(core.effect_cycle()), what});
  }
}

// --- pins ----------------------------------------------------------------------------------------

McuPin Board::Machine::mcu_pin(int pin) const {
  return sim::mcu_pin(model_, pin);
}

// Some pins have two numbers: the first is the one that counts.
std::size_t Board::Machine::index_of(McuPin pin) const {
  return static_cast<std::size_t>(std::find(model_.pins.begin(), model_.pins.end(), pin) -
                                  model_.pins.begin());
}

void Board::Machine::pin_changed(McuPin changed, AvrPorts::Level level) {
  const std::size_t index = index_of(changed);
  if (index >= pins_.size()) {
    return;
  }
  Pin& pin = pins_[index];
  const AvrPorts::Level before = std::exchange(pin.level, level);
  if (before == level) {
    return;
  }
  const Cycle cycle = core.effect_cycle();
  const bool high = level == std::optional(true);
  if (high) {
    pin.rise = cycle;
  } else if (pin.rise) {
    pin.pulse = cycle - *std::exchange(pin.rise, std::nullopt);
  }
  if (chip && index == index_of(mcu_pin(options_.chip_select_pin))) {
    edge_ = Edge{cycle, level == std::optional(false)};
    core.stop();
  }
  if (level && pin.listener) {
    post(cycle, [this, index, time = time_of(cycle), high] {
      if (const auto listener = pins_[index].listener) {
        listener(time, high);
      }
    });
  }
}

Board::Machine::Serial& Board::Machine::serial_slot(int number) {
  for (Serial& slot : serials_) {
    if (slot.number == number) {
      return slot;
    }
  }
  throw std::invalid_argument(std::string("a ") + model_.name + " has no serial port " +
                              std::to_string(number));
}

unsigned Board::Machine::adc_channel(int channel) const {
  return sim::adc_channel(model_, channel);
}

// --- the board -----------------------------------------------------------------------------------

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
  if (!machine_->chip) {
    throw std::logic_error(name() + " has no chip");
  }
  return *machine_->chip;
}

void Board::set_chip_fault(SpiWire::Fault fault) {
  machine_->set_chip_fault(fault);
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
  return machine_->ports.level(machine_->mcu_pin(pin));
}

void Board::on_pin(int pin, std::function<void(SimTime, bool)> listener) {
  machine_->listened_to();
  machine_->pin(pin).listener = std::move(listener);
}

void Board::set_analog(int channel, double volts) {
  machine_->adc.set(machine_->adc_channel(channel), volts);
}

std::optional<SimTime> Board::servo_pulse(int pin) const {
  const std::optional<Cycle> pulse = machine_->pin(pin).pulse;
  return pulse ? std::optional(static_cast<std::int64_t>(*pulse) * cycle_time) : std::nullopt;
}

std::optional<double> Board::servo_angle(int pin) const {
  const std::optional<SimTime> pulse = servo_pulse(pin);
  return pulse ? std::optional(sim::servo_angle(*pulse)) : std::nullopt;
}

void Board::on_serial(int port, std::function<void(std::uint8_t)> listener) {
  machine_->listened_to();
  machine_->serial_slot(port).listener = std::move(listener);
}

void Board::serial_write(int port, std::span<const std::uint8_t> bytes) {
  machine_->serial(port).receive(bytes);
}

std::size_t Board::serial_waiting(int port) const {
  return machine_->serial(port).waiting();
}

void Board::serial_hold(int port, bool holds) {
  if (!machine_->serial(port).hold(holds)) {
    throw std::invalid_argument(name() + ": serial port " + std::to_string(port) +
                                " is a UART, which nobody can hold");
  }
}

const SerialCounters& Board::serial_counters(int port) const {
  return std::as_const(machine_->serial(port)).counters();
}

std::optional<double> Board::serial_bitrate_bps(int port) const {
  return machine_->serial(port).bitrate_bps();
}

std::optional<double> Board::serial_sent_bitrate_bps(int port) const {
  return machine_->serial_slot(port).sent_bps;
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
