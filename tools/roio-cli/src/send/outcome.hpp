/// What became of the messages that a bus has accepted. Only a bridge tells: it knows of each
/// whether it was acknowledged, and gives up those whose time is over.
#ifndef ROIO_CLI_SEND_OUTCOME_HPP
#define ROIO_CLI_SEND_OUTCOME_HPP

#include <chrono>
#include <cstdint>
#include <roio/bus.hpp>
#include <string>

namespace roio::cli {

/// Whether a bridge has given up messages; false for every other bus.
bool has_given_up(Bus& bus);

/// Until it is known of each message what became of it, or a signal comes: no longer than the
/// lifetime with which the bus was opened, and a moment.
void wait_for_outcomes(Bus& bus);

/// Closes the bus: then the numbers are final.
/// @param accepted by the bus, of which a bridge says how many were really sent.
/// @return a line for the user, such as "serial:/dev/ttyACM0: not sent within 1000 ms: nobody
/// acknowledges, the bus is error-passive; 0 messages sent before".
std::string why_not_sent(Bus& bus, std::chrono::milliseconds timeout, std::uint64_t accepted);

/// Waits for what is known of the last messages, closes the bus, and tells on standard error how
/// many nobody else was there to have.
/// @throws Failure: some were given up, or not handed over.
void finish_sending(Bus& bus, std::chrono::milliseconds timeout, std::uint64_t accepted);

}  // namespace roio::cli

#endif
