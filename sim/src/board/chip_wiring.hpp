#ifndef ROIO_SIM_BOARD_CHIP_WIRING_HPP
#define ROIO_SIM_BOARD_CHIP_WIRING_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/mcp2515_chip.hpp>
#include <roio/sim/spi_wire.hpp>

#include "avr/board_model.hpp"
#include "avr/core.hpp"
#include "avr/ports.hpp"
#include "avr/spi.hpp"

namespace roio::sim {

/// The cable between the board and its chip: chip select and SPI one way, the interrupt line the
/// other. What the AVR has done to it already, and what has not happened there yet, since the AVR
/// runs ahead of the bus.
class ChipWiring {
 public:
  using Cycle = AvrCore::Cycle;

  /// What the wiring does to the board.
  struct Board {
    std::function<void(const char*)> violation;
    /// The interrupt line is at a level; none: the cable has come off.
    std::function<void(std::optional<bool>)> drive_interrupt;
    /// A byte was exchanged.
    std::function<void(std::uint8_t out, std::uint8_t in)> exchanged;
  };

  ChipWiring(AvrCore& core, AvrPorts& ports, AvrSpi& spi, const BoardModel& model, Board board);

  void plug_in(CanBus& bus, const Mcp2515Options& options);
  /// None: the board has no chip.
  [[nodiscard]] Mcp2515Chip* chip() { return chip_ ? &*chip_ : nullptr; }

  /// The program has moved chip select; the core runs no further before that has happened.
  void select_pin_changed(Cycle cycle, bool selected);
  /// The first thing that the AVR has done to the cable and that has not happened there yet.
  [[nodiscard]] std::optional<Cycle> next_contact() const;
  /// Now it happens.
  void make_contact();

  void set_fault(SpiWire::Fault fault);

 private:
  struct Edge {
    Cycle cycle;
    bool selected;
  };

  void finish_byte();
  [[nodiscard]] std::uint8_t exchange(std::uint8_t out);
  void select(bool selected);

  AvrCore& core_;
  AvrPorts& ports_;
  AvrSpi& spi_;
  const BoardModel& model_;
  Board board_;
  std::optional<Mcp2515Chip> chip_;
  std::optional<Edge> edge_;
  bool selected_ = false;       // as the program has it
  bool chip_selected_ = false;  // as the chip sees it
  SpiWire::Fault fault_ = SpiWire::Fault::none;
};

}  // namespace roio::sim

#endif
