/// What a UART makes of a line that is sent at another rate than its own. A pure function.
#ifndef ROIO_SIM_UART_SAMPLING_HPP
#define ROIO_SIM_UART_SAMPLING_HPP

#include <cstdint>
#include <span>
#include <vector>

namespace roio::sim {

/// Whether two UARTs understand one another: their rates differ by at most 4.5 %.
bool rates_match(double one_bps, double other_bps);

/// The bytes that a receiver of 8 data bits makes of others, sent without a pause, 8 data bits and
/// a stop bit each. It looks at each bit once, about an eighth of its bit off the middle, on the
/// side on which the difference tells first. A byte without a stop bit counts.
std::vector<std::uint8_t> sampled(std::span<const std::uint8_t> sent, double sender_bps,
                                  double receiver_bps);

}  // namespace roio::sim

#endif
