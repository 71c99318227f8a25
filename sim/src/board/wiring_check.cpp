#include "board/wiring_check.hpp"

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace roio::sim {

void check_wiring(const BoardModel& model, const BoardOptions& options) {
  const auto check_free = [&](const std::string& what, int pin) {
    const std::array<std::pair<McuPin, const char*>, 3> taken{
        {{model.mosi, "MOSI"}, {model.miso, "MISO"}, {model.sck, "SCK"}}};
    for (const auto& [of_spi, name] : taken) {
      if (mcu_pin(model, pin) == of_spi) {
        throw std::invalid_argument(what + " cannot be on pin " + std::to_string(pin) +
                                    ", which is SPI's " + name + " on a " + model.name);
      }
    }
  };
  const int select = options.chip_select_pin;
  check_free("chip select", select);
  if (!options.interrupt_pin) {
    return;
  }
  check_free("INT", *options.interrupt_pin);
  if (mcu_pin(model, *options.interrupt_pin) == mcu_pin(model, select)) {
    throw std::invalid_argument("chip select and INT cannot both be on pin " +
                                pin_name(model.kind, select));
  }
}

}  // namespace roio::sim
