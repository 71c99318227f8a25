#ifndef ROIO_SIM_BOARD_MACHINE_HPP
#define ROIO_SIM_BOARD_MACHINE_HPP

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <roio/sim/board.hpp>
#include <string>
#include <vector>

#include "avr/adc.hpp"
#include "avr/board_model.hpp"
#include "avr/core.hpp"
#include "avr/external_interrupts.hpp"
#include "avr/ports.hpp"
#include "avr/spi.hpp"
#include "board/chip_wiring.hpp"
#include "board/pins.hpp"
#include "board/serial_ports.hpp"

namespace roio::sim {

/// A cycle takes as long.
inline constexpr SimTime cycle_time = cycles(1, AvrCore::clock_hz);
static_assert(cycle_time * AvrCore::clock_hz == std::chrono::seconds(1));

/// The AVR, what is around it, and how it keeps in step with the bus.
class Board::Machine : public CanBus::Companion,
                       public std::enable_shared_from_this<Board::Machine> {
 public:
  using Cycle = AvrCore::Cycle;

  Machine(CanBus& bus, BoardKind kind, const std::filesystem::path& elf,
          const BoardOptions& options);
  ~Machine() override { bus_.detach(*this); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  void step() override;
  void reset();
  /// Somebody listens: what the board does may act on others at once.
  void listened_to() { reach = SimTime(0); }

  [[nodiscard]] SimTime now() const { return time_of(core.cycle()); }
  [[nodiscard]] const BoardModel& model() const { return model_; }
  /// From outside; none: no longer.
  void drive(int pin, std::optional<bool> level);

  std::string name;
  AvrCore core;
  AvrPorts ports;
  AvrExternalInterrupts interrupts;
  AvrSpi spi;
  AvrAdc adc;
  BoardPins pins;
  ChipWiring wiring;
  SerialPorts serials;
  std::uint64_t resets = 0;
  std::vector<Mcp2515Violation> violations;
  std::function<void(SimTime, std::uint8_t, std::uint8_t)> spi_listener;

 private:
  [[nodiscard]] SimTime time_of(Cycle cycle) const {
    return origin_ + static_cast<std::int64_t>(cycle) * cycle_time;
  }
  [[nodiscard]] Cycle cycle_at(SimTime time) const {
    return static_cast<Cycle>((time - origin_) / cycle_time);
  }
  [[nodiscard]] ChipWiring::Board around_the_chip();
  void add_serial_ports();
  void connect_core();
  void post(Cycle cycle, std::function<void()> action);
  void tell_trouble();
  void restarted();
  void pin_changed(McuPin changed, AvrPorts::Level level);
  void exchanged(std::uint8_t out, std::uint8_t in);
  void violation(const char* what);

  CanBus& bus_;
  const BoardModel& model_;
  BoardOptions options_;
  SimTime origin_;
  bool dead_ = false;  // and told so
};

}  // namespace roio::sim

#endif
