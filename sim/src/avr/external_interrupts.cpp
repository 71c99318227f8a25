#include "avr/external_interrupts.hpp"

namespace roio::sim {
namespace {

constexpr std::uint16_t first_tifr = 0x35;
constexpr std::uint16_t pcifr = 0x3B;
constexpr std::uint16_t eifr = 0x3C;
constexpr std::uint16_t eimsk = 0x3D;
constexpr std::uint16_t pcicr = 0x68;
constexpr std::uint16_t eicra = 0x69;
constexpr std::uint16_t eicrb = 0x6A;
constexpr unsigned lines_per_register = 4;

}  // namespace

AvrExternalInterrupts::AvrExternalInterrupts(AvrCore& core, const AvrPorts& ports,
                                             const BoardModel& model)
    : core_(core), ports_(ports) {
  for (const McuInterrupt& made : model.interrupts) {
    lines_.push_back({made.number, made.pin, &core.vector(eimsk, made.number)});
  }
  const avr_int_table_t& table = core.avr()->interrupts;
  for (int i = 0; i < table.vector_count; ++i) {
    const auto flags = table.vector[i]->raised.reg;
    if (flags == eifr || flags == pcifr) {
      vectors_.push_back(table.vector[i]);
    }
  }
  core.take_writes<&AvrExternalInterrupts::write_plain>(eicra, *this);
  core.take_writes<&AvrExternalInterrupts::write_plain>(eicrb, *this);
  for (const std::uint16_t address : {eimsk, pcicr}) {
    core.take_writes<&AvrExternalInterrupts::write_enable>(address, *this);
  }
  for (const std::uint16_t address : {eifr, pcifr}) {
    core.take_writes<&AvrExternalInterrupts::write_flags>(address, *this);
  }
  std::uint16_t address = first_tifr;
  for (TimerFlags& timer : timers_) {
    const auto& slot = core.avr()->io[AVR_DATA_TO_IO(address)].w;
    if (slot.c != nullptr) {
      timer = {&core, slot.c, slot.param};
      core.take_writes<&TimerFlags::write_flags>(address, timer);
    }
    ++address;
  }
  reset();
}

void AvrExternalInterrupts::reset() {
  for (const Line& line : lines_) {
    avr_extint_set_strict_lvl_trig(core_.avr(), static_cast<std::uint8_t>(line.number), 0);
  }
}

void AvrExternalInterrupts::TimerFlags::write_flags(std::uint16_t address,
                                                    std::uint8_t value) const {
  write(core->avr(), address, core->written_ones(value), parameter);
}

void AvrExternalInterrupts::write_plain(std::uint16_t address, std::uint8_t value) {
  core_.data(address) = value;
  update();
}

void AvrExternalInterrupts::write_enable(std::uint16_t address, std::uint8_t value) {
  core_.data(address) = value;
  for (avr_int_vector_t* const vector : vectors_) {
    if (vector->enable.reg == address && avr_regbit_get(core_.avr(), vector->raised) != 0) {
      core_.raise(*vector);
    }
  }
  update();
}

void AvrExternalInterrupts::write_flags(std::uint16_t address, std::uint8_t value) {
  const unsigned ones = core_.written_ones(value);
  for (avr_int_vector_t* const vector : vectors_) {
    if (vector->raised.reg == address && (ones & 1U << vector->raised.bit) != 0) {
      core_.clear(*vector);
    }
  }
  update();
}

bool AvrExternalInterrupts::by_level(const Line& line) const {
  const std::uint16_t address = line.number < lines_per_register ? eicra : eicrb;
  const unsigned shift = 2 * (line.number % lines_per_register);
  return (core_.data(address) & 3U << shift) == 0;
}

bool AvrExternalInterrupts::is_low(const Line& line) const {
  return !ports_.level(line.pin).value_or(ports_.input(line.pin));
}

// 12.2.1: no flag for a level; it must last until the interrupt is entered.
void AvrExternalInterrupts::update() const {
  for (const Line& line : lines_) {
    if (!by_level(line)) {
      continue;
    }
    const bool enabled = (core_.data(eimsk) & 1U << line.number) != 0;
    if (enabled && is_low(line)) {
      core_.raise(*line.vector);
    } else {
      core_.clear(*line.vector);
    }
  }
}

}  // namespace roio::sim
