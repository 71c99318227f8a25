/// AvrPorts: the pins of an AVR, both ways, over simavr's ports.
#ifndef ROIO_SIM_AVR_PORTS_HPP
#define ROIO_SIM_AVR_PORTS_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "avr/core.hpp"

namespace roio::sim {

class AvrPorts {
 public:
  /// What a pin is driven to; none while it is an input.
  using Level = std::optional<bool>;

  AvrPorts(AvrCore& core, const BoardModel& model);

  /// Called when that changes.
  void on_change(std::function<void(McuPin, Level)> listener) { changed_ = std::move(listener); }
  [[nodiscard]] Level level(McuPin pin) const;
  /// What the program reads there.
  [[nodiscard]] bool input(McuPin pin) const;
  /// What something outside drives it to.
  [[nodiscard]] Level outside(McuPin pin) const;
  void drive(McuPin pin, bool high);
  void release(McuPin pin);
  void reset();

 private:
  struct Port {
    AvrPorts* owner;
    AvrCore* core;
    char name;
    std::uint16_t pin_register;
    std::uint8_t direction = 0;  // as last told
    std::uint8_t output = 0;
    std::uint8_t driven_mask = 0;  // from outside
    std::uint8_t driven_value = 0;
    avr_io_write_t direction_write = nullptr;  // simavr's
    void* direction_parameter = nullptr;
    avr_io_write_t pin_write = nullptr;
    void* pin_parameter = nullptr;

    void write_direction(std::uint16_t address, std::uint8_t value);
    void write_pin(std::uint16_t address, std::uint8_t value) const;
    void update();
    void tell_simavr() const;
    void raise(unsigned bit, bool high) const;
    [[nodiscard]] avr_irq_t& line(unsigned bit) const;
  };
  [[nodiscard]] Port& port(char name) const;

  std::vector<std::unique_ptr<Port>> ports_;
  std::function<void(McuPin, Level)> changed_;
};

}  // namespace roio::sim

#endif
