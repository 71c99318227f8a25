/// Where the chip of a board can be.
#ifndef ROIO_SIM_BOARD_WIRING_CHECK_HPP
#define ROIO_SIM_BOARD_WIRING_CHECK_HPP

#include <roio/sim/board.hpp>

#include "avr/board_model.hpp"

namespace roio::sim {

/// @throws std::invalid_argument: chip select or INT is on a pin that the board does not have or
///         that is SPI's own, or both are on one pin.
void check_wiring(const BoardModel& model, const BoardOptions& options);

}  // namespace roio::sim

#endif
