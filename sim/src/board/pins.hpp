#ifndef ROIO_SIM_BOARD_PINS_HPP
#define ROIO_SIM_BOARD_PINS_HPP

#include <functional>
#include <optional>
#include <roio/sim/time.hpp>
#include <vector>

#include "avr/board_model.hpp"
#include "avr/core.hpp"
#include "avr/ports.hpp"

namespace roio::sim {

/// A board's pins by Arduino's numbers: what it drives them to, how long their pulses are, and who
/// wants to know.
class BoardPins {
 public:
  explicit BoardPins(const BoardModel& model) : model_(model), pins_(model.pins.size()) {}

  /// @throws std::invalid_argument: the board has no such pin.
  [[nodiscard]] McuPin mcu_pin(int number) const;
  /// The ADC's, by Arduino's. @throws std::invalid_argument: the board has no such input.
  [[nodiscard]] unsigned adc_channel(int channel) const;

  struct Pin {
    AvrPorts::Level level;
    std::optional<AvrCore::Cycle> rise;   // of the pulse that lasts
    std::optional<AvrCore::Cycle> pulse;  // the length of the last whole one
    std::function<void(SimTime, bool)> listener;
  };
  /// It stays where it is. A pin that has two numbers is one.
  /// @throws std::invalid_argument: the board has no such pin.
  [[nodiscard]] Pin& at(int number) { return pins_[index_of(mcu_pin(number))]; }

  /// The program has changed what it does to a pin.
  /// @return that pin; none: Arduino has no number for it, or nothing changed.
  Pin* change(McuPin changed, AvrPorts::Level level, AvrCore::Cycle cycle);

 private:
  [[nodiscard]] std::size_t index_of(McuPin pin) const;

  const BoardModel& model_;
  std::vector<Pin> pins_;
};

}  // namespace roio::sim

#endif
