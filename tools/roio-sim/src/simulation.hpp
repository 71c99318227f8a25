/// The boards on their bus, in step with real time, the other bus, standard input and output.
#ifndef ROIO_SIM_TOOL_SIMULATION_HPP
#define ROIO_SIM_TOOL_SIMULATION_HPP

#include "options.hpp"

namespace roio::sim_tool {

/// @return the exit status: 0 at the asked-for end, 1 when lines of the input could not be
///         understood (from a terminal, that is no failure), 128 plus the signal.
/// @throws cli::UsageError, cli::Failure (a board that cannot go on), cli::BrokenPipe,
///         std::system_error.
int simulate(const Options& options);

}  // namespace roio::sim_tool

#endif
