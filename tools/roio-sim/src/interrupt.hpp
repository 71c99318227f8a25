/// SIGINT and SIGTERM end the simulation cleanly; a second one kills. SIGPIPE is left to write(),
/// which reports it.
#ifndef ROIO_SIM_TOOL_INTERRUPT_HPP
#define ROIO_SIM_TOOL_INTERRUPT_HPP

namespace roio::sim_tool {

void catch_signals();

/// The signal that came, or 0. Nothing is woken by one: who waits, waits for moments only.
int caught_signal() noexcept;

}  // namespace roio::sim_tool

#endif
