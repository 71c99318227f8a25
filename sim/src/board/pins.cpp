#include "board/pins.hpp"

#include <algorithm>
#include <utility>

namespace roio::sim {

McuPin BoardPins::mcu_pin(int number) const {
  return sim::mcu_pin(model_, number);
}

unsigned BoardPins::adc_channel(int channel) const {
  return sim::adc_channel(model_, channel);
}

// Some pins have two numbers: the first is the one that counts.
std::size_t BoardPins::index_of(McuPin pin) const {
  return static_cast<std::size_t>(std::find(model_.pins.begin(), model_.pins.end(), pin) -
                                  model_.pins.begin());
}

BoardPins::Pin* BoardPins::change(McuPin changed, AvrPorts::Level level, AvrCore::Cycle cycle) {
  const std::size_t index = index_of(changed);
  if (index >= pins_.size()) {
    return nullptr;
  }
  Pin& pin = pins_[index];
  if (std::exchange(pin.level, level) == level) {
    return nullptr;
  }
  if (level == std::optional(true)) {
    pin.rise = cycle;
  } else if (pin.rise) {
    pin.pulse = cycle - *std::exchange(pin.rise, std::nullopt);
  }
  return &pin;
}

}  // namespace roio::sim
