/// The commands that roio-sim takes while it runs, one a line. Pure functions.
///
///   sensors press 4         a button to ground, for 0.1 s
///   sensors hold 4          the same, until: sensors release 4
///   sensors pin 7 high      high, low or open
///   sensors analog A0 0.5   or volts: 2.5V
///   arm serial hello        the text and a line end, to the first UART (serial1 TEXT: to UART 1)
///   arm reset               the reset button
///   arm unplug              the chip's cable, until: arm plug
///   arm unplug serial       its terminal, until: arm plug serial
///   wait 0.5                what follows is done so much simulated time later
///   quit, help
#ifndef ROIO_SIM_TOOL_BOARD_COMMAND_HPP
#define ROIO_SIM_TOOL_BOARD_COMMAND_HPP

#include <cstdint>
#include <optional>
#include <roio/sim/time.hpp>
#include <roio/text.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "board_words.hpp"

namespace roio::sim_tool {

struct Press {
  PinName pin;
};
struct SetPin {
  PinName pin;
  std::optional<bool> high;  ///< None: nothing drives it any more.
};
struct SetAnalog {
  int channel = 0;
  double volts = 0;
};
struct Serial {
  int uart = 0;      ///< Arduino's Serial; 1 is Serial1.
  std::string text;  ///< Without a line end.
};
struct Reset {};
enum class Cable : std::uint8_t { chip, terminal };
struct Plug {
  bool in = true;
  Cable cable = Cable::chip;
};
struct Wait {
  sim::SimTime time;
};
/// Whether nobody but the boards is on their bus.
struct Alone {
  bool alone = true;
};
struct Quit {};
struct Help {};

using Action = std::variant<Press, SetPin, SetAnalog, Serial, Reset, Plug, Wait, Alone, Quit, Help>;

struct Instruction {
  std::string board;  ///< Empty for wait, alone, together, quit and help.
  Action action;
};

/// @param line not blank.
/// @return or an error that says what was expected, without the line.
Parsed<Instruction> parse_instruction(std::string_view line);

/// All commands, a line each.
extern const char* const command_help;

}  // namespace roio::sim_tool

#endif
