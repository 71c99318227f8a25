#include "avr/adc.hpp"

#include <algorithm>
#include <cmath>

namespace roio::sim {
namespace {

constexpr std::uint16_t adcl = 0x78;
constexpr std::uint16_t adch = 0x79;
constexpr std::uint16_t adcsra = 0x7A;
constexpr std::uint16_t adcsrb = 0x7B;
constexpr std::uint16_t admux = 0x7C;
constexpr unsigned adsc = 0x40;
constexpr unsigned adlar = 0x20;
constexpr unsigned mux5_of_32u4 = 0x20;  // in ADCSRB
constexpr unsigned mux5_of_2560 = 0x08;
constexpr unsigned band_gap_mux = 0x1E;
constexpr double supply = 5.0;
constexpr double band_gap = 1.1;
constexpr double larger_reference = 2.56;
constexpr unsigned steps = 1024;

}  // namespace

AvrAdc::AvrAdc(AvrCore& core, BoardKind kind) : core_(core), kind_(kind) {
  core.take_reads<&AvrAdc::read_low>(adcl, *this);
  core.take_reads<&AvrAdc::read_high>(adch, *this);
  avr_irq_register_notify(avr_io_getirq(core.avr(), AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER),
                          triggered, this);
}

void AvrAdc::reset() {
  before_ = last_ = 0;
  is_locked_ = false;
}

void AvrAdc::triggered(avr_irq_t* /*irq*/, std::uint32_t /*value*/, void* parameter) {
  auto& adc = *static_cast<AvrAdc*>(parameter);
  adc.before_ = adc.last_;
  adc.last_ = adc.convert();
}

// Differential inputs and the thermometer read 0.
double AvrAdc::input() const {
  const unsigned mux = core_.data(admux);
  if (kind_ == BoardKind::uno) {
    const unsigned channel = mux & 0x0FU;
    return channel < 8 ? volts_.at(channel) : channel == 0x0E ? band_gap : 0.0;
  }
  const unsigned mux5 = kind_ == BoardKind::leonardo ? mux5_of_32u4 : mux5_of_2560;
  const bool upper = (core_.data(adcsrb) & mux5) != 0;
  const unsigned channel = mux & 0x1FU;
  if (channel < 8) {
    return volts_.at(channel + (upper ? 8U : 0U));
  }
  return channel == band_gap_mux && !upper ? band_gap : 0.0;
}

double AvrAdc::reference() const {
  switch (core_.data(admux) >> 6) {
    case 0:  // AREF: nothing is connected there, and a careful program does not use it
    case 1:
      return supply;
    case 2:
      return band_gap;
    default:
      return kind_ == BoardKind::uno ? band_gap : larger_reference;
  }
}

unsigned AvrAdc::convert() const {
  const double value = std::floor(input() * steps / reference() + 1e-9);
  return static_cast<unsigned>(std::clamp(value, 0.0, double{steps - 1}));
}

std::uint16_t AvrAdc::result() const {
  const unsigned value = (core_.data(adcsra) & adsc) != 0 ? before_ : last_;
  return static_cast<std::uint16_t>((core_.data(admux) & adlar) != 0 ? value << 6 : value);
}

std::uint8_t AvrAdc::read_low(std::uint16_t /*address*/) {
  locked_ = result();
  is_locked_ = true;
  return static_cast<std::uint8_t>(locked_ & 0xFF);
}

std::uint8_t AvrAdc::read_high(std::uint16_t /*address*/) {
  const std::uint16_t value = is_locked_ ? locked_ : result();
  is_locked_ = false;
  return static_cast<std::uint8_t>(value >> 8);
}

}  // namespace roio::sim
