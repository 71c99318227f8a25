#include "board/pins.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace roio::sim {

McuPin BoardPins::mcu_pin(int number) const {
  if (number < 0 || static_cast<std::size_t>(number) >= model_.pins.size()) {
    throw std::invalid_argument(std::string("a ") + model_.name + " has no pin " +
                                std::to_string(number));
  }
  return model_.pins[static_cast<std::size_t>(number)];
}

unsigned BoardPins::adc_channel(int channel) const {
  if (channel < 0 || static_cast<std::size_t>(channel) >= model_.analog_channels.size()) {
    throw std::invalid_argument(std::string("a ") + model_.name + " has no analog input A" +
                                std::to_string(channel));
  }
  return model_.analog_channels[static_cast<std::size_t>(channel)];
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
