/// AvrAdc: what the ADC of an AVR finds at its pins. The time of a conversion is simavr's; the
/// value is ours, because simavr samples when the result is read, knows eight channels, and is one
/// off at most voltages. Source: ATmega328P, 32U4 and 2560 datasheets, "ADC".
#ifndef ROIO_SIM_AVR_ADC_HPP
#define ROIO_SIM_AVR_ADC_HPP

#include <array>
#include <cstdint>

#include "avr/core.hpp"

namespace roio::sim {

class AvrAdc {
 public:
  AvrAdc(AvrCore& core, BoardKind kind);

  /// @param channel the ADC's own, 0..15.
  void set(unsigned channel, double volts) { volts_.at(channel) = volts; }
  void reset();

 private:
  static void triggered(avr_irq_t* irq, std::uint32_t value, void* parameter);
  [[nodiscard]] double input() const;
  [[nodiscard]] double reference() const;
  [[nodiscard]] unsigned convert() const;
  [[nodiscard]] std::uint16_t result() const;
  std::uint8_t read_low(std::uint16_t address);
  std::uint8_t read_high(std::uint16_t address);

  AvrCore& core_;
  BoardKind kind_;
  std::array<double, 16> volts_{};
  unsigned before_ = 0;  // of the conversion before the last that began
  unsigned last_ = 0;
  std::uint16_t locked_ = 0;  // ADCH keeps the value of which ADCL was read
  bool is_locked_ = false;
};

}  // namespace roio::sim

#endif
