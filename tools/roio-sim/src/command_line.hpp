/// The command line of roio-sim.
#ifndef ROIO_SIM_TOOL_COMMAND_LINE_HPP
#define ROIO_SIM_TOOL_COMMAND_LINE_HPP

#include <string>
#include <variant>

#include "options.hpp"

namespace roio::sim_tool {

/// A text to print instead of doing anything: --help, --version.
struct Information {
  std::string text;
};

/// @throws cli::UsageError: what was wrong with the words, and what was expected.
std::variant<Information, Options> parse_command_line(int argc, const char* const* argv);

}  // namespace roio::sim_tool

#endif
