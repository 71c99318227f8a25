/// What the words of roio-sim's command line ask for.
#ifndef ROIO_SIM_TOOL_OPTIONS_HPP
#define ROIO_SIM_TOOL_OPTIONS_HPP

#include <cstdint>
#include <optional>
#include <roio/sim/board.hpp>
#include <string>
#include <vector>

#include "board_command.hpp"

namespace roio::sim_tool {

struct BoardWish {
  std::string name;
  sim::BoardKind kind = sim::BoardKind::uno;
  std::string kind_word;  ///< As it was written: nano, which is an uno.
  std::string elf;        ///< Or a sketch, until it is built (sketch.hpp).
  sim::BoardOptions options;
  bool has_terminal = false;
  std::string terminal_link;  ///< Where it is to be found; empty: only under its own name.
};

struct Options {
  std::optional<std::string> bus;  ///< As roio::open() takes it; none: the boards are alone.
  std::uint32_t bitrate_bps = 500'000;
  double speed = 1;                       ///< Times real time; 0: as fast as it goes.
  std::optional<sim::SimTime> end;        ///< Simulated time.
  std::vector<BoardWish> boards;          ///< At least one.
  std::vector<Instruction> instructions;  ///< Done first of all.
  bool json = false;
  bool verbose = false;
};

}  // namespace roio::sim_tool

#endif
