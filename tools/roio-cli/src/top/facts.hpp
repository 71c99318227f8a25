/// The lines about the bus as a whole, above the rows of `roio-cli top`.
#ifndef ROIO_CLI_FACTS_HPP
#define ROIO_CLI_FACTS_HPP

#include <cstddef>
#include <string>
#include <vector>

#include "top/snapshot.hpp"

namespace roio::cli {

/// @return three lines: what the bus is, how busy it is, and what was counted.
std::vector<std::string> fact_lines(const Snapshot& snapshot, bool paused, std::size_t columns,
                                    bool colour);

}  // namespace roio::cli

#endif
