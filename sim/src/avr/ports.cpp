#include "avr/ports.hpp"

#include <algorithm>
#include <stdexcept>

namespace roio::sim {
namespace {

bool is_set(std::uint8_t byte, unsigned bit) {
  return (byte & 1U << bit) != 0;
}

std::uint8_t with_bit(std::uint8_t byte, unsigned bit, bool on) {
  return static_cast<std::uint8_t>(on ? byte | 1U << bit : byte & ~(1U << bit));
}

}  // namespace

AvrPorts::AvrPorts(AvrCore& core, const BoardModel& model) {
  for (const McuPort& made : model.ports) {
    ports_.push_back(std::make_unique<Port>());
    Port& port = *ports_.back();
    port.owner = this;
    port.core = &core;
    port.name = made.name;
    port.pin_register = made.pin_register;
    auto& pin_slot = core.avr()->io[AVR_DATA_TO_IO(port.pin_register)].w;
    port.pin_write = pin_slot.c;
    port.pin_parameter = pin_slot.param;
    core.take_writes<&Port::write_pin>(port.pin_register, port);
    const auto direction = static_cast<std::uint16_t>(port.pin_register + 1);
    auto& direction_slot = core.avr()->io[AVR_DATA_TO_IO(direction)].w;
    port.direction_write = direction_slot.c;
    port.direction_parameter = direction_slot.param;
    core.take_writes<&Port::write_direction>(direction, port);
    // The timers' outputs come by here, too. Unfiltered: a restart changes registers silently.
    avr_irq_t& written = port.line(IOPORT_IRQ_REG_PORT);
    written.flags = static_cast<std::uint8_t>(written.flags & ~unsigned{IRQ_FLAG_FILTERED});
    avr_irq_register_notify(
        &written,
        [](avr_irq_t* /*irq*/, std::uint32_t /*value*/, void* parameter) {
          static_cast<Port*>(parameter)->update();
        },
        &port);
  }
}

AvrPorts::Port& AvrPorts::port(char name) const {
  const auto found = std::find_if(ports_.begin(), ports_.end(),
                                  [&](const auto& port) { return port->name == name; });
  if (found == ports_.end()) {
    throw std::logic_error(std::string("no port ") + name);
  }
  return **found;
}

// --- what the program does -----------------------------------------------------------------------

void AvrPorts::Port::write_direction(std::uint16_t address, std::uint8_t value) {
  direction_write(core->avr(), address, value, direction_parameter);
  update();
}

// Ones toggle.
void AvrPorts::Port::write_pin(std::uint16_t address, std::uint8_t value) const {
  pin_write(core->avr(), address, core->written_ones(value), pin_parameter);
}

void AvrPorts::Port::update() {
  const std::uint8_t now_direction = core->data(static_cast<std::uint16_t>(pin_register + 1));
  const std::uint8_t now_output = core->data(static_cast<std::uint16_t>(pin_register + 2));
  const unsigned changed =
      (direction ^ now_direction) | ((output ^ now_output) & (direction & now_direction));
  direction = now_direction;
  output = now_output;
  for (unsigned bit = 0; bit < 8; ++bit) {
    if ((changed >> bit & 1U) != 0 && owner->changed_) {
      const McuPin pin{name, static_cast<std::uint8_t>(bit)};
      owner->changed_(pin, owner->level(pin));
    }
  }
}

// simavr clears the inputs, too, and then tells only of those that change. They are as they were.
void AvrPorts::reset() {
  for (const auto& port : ports_) {
    port->tell_simavr();
    std::uint8_t inputs = port->driven_value;
    for (unsigned bit = 0; bit < 8; ++bit) {
      avr_irq_t& line = port->line(bit);
      if (!is_set(port->driven_mask, bit)) {
        inputs = with_bit(inputs, bit, line.value != 0);
      }
      line.value = is_set(inputs, bit) ? 1 : 0;
    }
    port->core->data(port->pin_register) = inputs;
    port->update();
  }
}

// --- what comes from outside ---------------------------------------------------------------------

// With this simavr keeps to the level when the port is written, in place of the pull-up's.
void AvrPorts::Port::tell_simavr() const {
  avr_ioport_external_t external{};
  external.name = static_cast<unsigned char>(name) & 0x7FU;
  external.mask = driven_mask;
  external.value = driven_value;
  avr_ioctl(core->avr(), static_cast<std::uint32_t>(AVR_IOCTL_IOPORT_SET_EXTERNAL(name)),
            &external);
}

avr_irq_t& AvrPorts::Port::line(unsigned bit) const {
  return *avr_io_getirq(core->avr(), static_cast<std::uint32_t>(AVR_IOCTL_IOPORT_GETIRQ(name)),
                        static_cast<int>(bit));
}

void AvrPorts::Port::raise(unsigned bit, bool high) const {
  avr_raise_irq(&line(bit), high ? 1 : 0);
}

void AvrPorts::drive(McuPin pin, bool high) {
  Port& at = port(pin.port);
  at.driven_mask = with_bit(at.driven_mask, pin.bit, true);
  at.driven_value = with_bit(at.driven_value, pin.bit, high);
  at.tell_simavr();
  if (!level(pin)) {
    at.raise(pin.bit, high);
  }
}

void AvrPorts::release(McuPin pin) {
  Port& at = port(pin.port);
  at.driven_mask = with_bit(at.driven_mask, pin.bit, false);
  at.driven_value = with_bit(at.driven_value, pin.bit, false);
  at.tell_simavr();
  if (!level(pin) && is_set(at.output, pin.bit)) {
    at.raise(pin.bit, true);
  }
}

AvrPorts::Level AvrPorts::level(McuPin pin) const {
  const Port& at = port(pin.port);
  return is_set(at.direction, pin.bit) ? Level(is_set(at.output, pin.bit)) : std::nullopt;
}

AvrPorts::Level AvrPorts::outside(McuPin pin) const {
  const Port& at = port(pin.port);
  return is_set(at.driven_mask, pin.bit) ? Level(is_set(at.driven_value, pin.bit)) : std::nullopt;
}

bool AvrPorts::input(McuPin pin) const {
  const Port& at = port(pin.port);
  return is_set(at.core->data(at.pin_register), pin.bit);
}

}  // namespace roio::sim
