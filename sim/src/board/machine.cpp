#include "board/machine.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "avr/image.hpp"
#include "avr/uart.hpp"
#include "avr/usb_serial.hpp"
#include "board/wiring_check.hpp"

namespace roio::sim {
namespace {

// What a chip sends on an idle bus reaches no other chip's interrupt line for as long: at 1 Mbit/s,
// a frame has 44 bits at least. (Only a chip asleep notices the first.)
constexpr SimTime silence = std::chrono::microseconds(20);

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

Board::Machine::Machine(CanBus& bus, BoardKind kind, const std::filesystem::path& elf,
                        const BoardOptions& options)
    : name(name_of(kind, elf, options)),
      core(model_of(kind), image_for(model_of(kind), elf)),
      ports(core, model_of(kind)),
      interrupts(core, ports, model_of(kind)),
      spi(core),
      adc(core, kind),
      pins(model_of(kind)),
      wiring(core, ports, spi, model_of(kind), around_the_chip()),
      serials(
          model_of(kind),
          [this](Cycle cycle, std::function<void()> action) { post(cycle, std::move(action)); }),
      bus_(bus),
      model_(model_of(kind)),
      options_(options),
      origin_(bus.now()) {
  check_wiring(model_, options);
  add_serial_ports();
  connect_core();
  if (options.has_chip) {
    wiring.plug_in(bus, options.chip);
  }
  reach = silence;
  next = bus.now();
  bus.attach(*this);
}

ChipWiring::Board Board::Machine::around_the_chip() {
  return {.violation = [this](const char* what) { violation(what); },
          .drive_interrupt =
              [this](std::optional<bool> level) {
                if (options_.interrupt_pin) {
                  drive(*options_.interrupt_pin, level);
                }
              },
          .exchanged = [this](std::uint8_t out, std::uint8_t in) { exchanged(out, in); }};
}

void Board::Machine::add_serial_ports() {
  if (model_.has_usb) {
    auto usb = std::make_unique<UsbSerial>(core);
    usb->on_violation([this](const char* what) { violation(what); });
    serials.add(0, std::move(usb));
  }
  for (const McuUart& made : model_.uarts) {
    serials.add(made.number, std::make_unique<AvrUart>(core, made.base));
  }
}

void Board::Machine::connect_core() {
  core.on_restart([this] { restarted(); });
  core.on_interrupt([this](const avr_int_vector_t& vector) {
    serials.interrupt_entered(vector);
    interrupts.update();
  });
  ports.on_change([this](McuPin pin, AvrPorts::Level level) {
    pin_changed(pin, level);
    interrupts.update();
  });
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

void Board::Machine::step() {
  for (;;) {
    if (const std::optional<Cycle> contact = wiring.next_contact()) {
      if (time_of(*contact) > bus_.now()) {
        next = time_of(*contact);
        return;
      }
      wiring.make_contact();
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
  spi.reset();
  adc.reset();
  serials.reset();
  ports.reset();
  interrupts.reset();
}

// --- what is around the AVR ----------------------------------------------------------------------

void Board::Machine::drive(int pin, std::optional<bool> level) {
  if (level) {
    ports.drive(pins.mcu_pin(pin), *level);
  } else {
    ports.release(pins.mcu_pin(pin));
  }
  interrupts.update();
}

void Board::Machine::pin_changed(McuPin changed, AvrPorts::Level level) {
  const Cycle cycle = core.effect_cycle();
  BoardPins::Pin* const pin = pins.change(changed, level, cycle);
  if (pin == nullptr) {
    return;
  }
  if (wiring.chip() != nullptr && pin == &pins.at(options_.chip_select_pin)) {
    wiring.select_pin_changed(cycle, level == std::optional(false));
  }
  if (level && pin->listener) {
    post(cycle, [pin, time = time_of(cycle), high = *level] {
      if (const auto listener = pin->listener) {
        listener(time, high);
      }
    });
  }
}

void Board::Machine::exchanged(std::uint8_t out, std::uint8_t in) {
  if (!spi_listener) {
    return;
  }
  bus_.at(bus_.now(), [weak = weak_from_this(), time = bus_.now(), out, in] {
    if (const auto self = weak.lock(); self && self->spi_listener) {
      const auto listener = self->spi_listener;
      listener(time, out, in);
    }
  });
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

}  // namespace roio::sim
