/// The three boards: which pin of the MCU Arduino's numbers mean, and what the MCU has.
/// Source: Arduino's variants (standard, leonardo, mega), and the MCUs' datasheets.
#ifndef ROIO_SIM_BOARD_MODEL_HPP
#define ROIO_SIM_BOARD_MODEL_HPP

#include <cstdint>
#include <roio/sim/board.hpp>
#include <span>
#include <string_view>

namespace roio::sim {

/// One pin of the MCU, such as B5.
struct McuPin {
  char port;
  std::uint8_t bit;
  friend bool operator==(const McuPin&, const McuPin&) = default;
};

struct McuPort {
  char name;
  std::uint16_t pin_register;  // PINx; DDRx and PORTx follow
};

struct McuUart {
  int number;
  std::uint16_t base;  // UCSRnA; the others at the same distances in all three MCUs
};

/// INTn
struct McuInterrupt {
  unsigned number;
  McuPin pin;
};

struct BoardModel {
  BoardKind kind;
  const char* name;
  const char* mcu;
  unsigned architecture;  // avr-gcc's
  std::uint32_t flash_bytes;
  std::span<const McuPin> pins;  // by Arduino's number
  int first_analog_pin;
  std::span<const std::uint8_t> analog_channels;  // the ADC's, by Arduino's
  std::span<const McuPort> ports;
  std::span<const McuUart> uarts;
  bool has_usb;  // which is Arduino's Serial then, number 0
  std::span<const McuInterrupt> interrupts;
  McuPin ss;
  McuPin mosi;
  McuPin miso;
  McuPin sck;
};

const BoardModel& model_of(BoardKind kind);

/// @throws std::invalid_argument: no such pin, no such analog input.
McuPin mcu_pin(const BoardModel& model, int pin);
std::uint8_t adc_channel(const BoardModel& model, int channel);

}  // namespace roio::sim

#endif
