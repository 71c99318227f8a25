/// AvrExternalInterrupts: INTn and the flags of pin changes, as the datasheet has them. simavr
/// polls a low level at each cycle, never clears a flag in EIFR or PCIFR, and forgets one that was
/// set while its interrupt was off. Source: ATmega328P datasheet, 12.
#ifndef ROIO_SIM_AVR_EXTERNAL_INTERRUPTS_HPP
#define ROIO_SIM_AVR_EXTERNAL_INTERRUPTS_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "avr/core.hpp"
#include "avr/ports.hpp"

namespace roio::sim {

class AvrExternalInterrupts {
 public:
  AvrExternalInterrupts(AvrCore& core, const AvrPorts& ports, const BoardModel& model);

  /// A pin may have changed, or an interrupt was entered: a low level asks as long as it lasts.
  void update() const;
  void reset();

 private:
  struct Line {
    unsigned number;
    McuPin pin;
    avr_int_vector_t* vector;
  };
  // One of TIFR0 to TIFR5, which are simavr's, but for SBI.
  struct TimerFlags {
    AvrCore* core;
    avr_io_write_t write;
    void* parameter;
    void write_flags(std::uint16_t address, std::uint8_t value) const;
  };

  void write_plain(std::uint16_t address, std::uint8_t value);
  void write_enable(std::uint16_t address, std::uint8_t value);
  void write_flags(std::uint16_t address, std::uint8_t value);
  [[nodiscard]] bool by_level(const Line& line) const;
  [[nodiscard]] bool is_low(const Line& line) const;

  AvrCore& core_;
  const AvrPorts& ports_;
  std::vector<Line> lines_;
  std::vector<avr_int_vector_t*> vectors_;  // all that have a flag in EIFR or PCIFR
  std::array<TimerFlags, 6> timers_{};
};

}  // namespace roio::sim

#endif
