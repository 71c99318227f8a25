/// The words of the command line that are about boards. Pure functions.
#ifndef ROIO_SIM_TOOL_BOARD_WORDS_HPP
#define ROIO_SIM_TOOL_BOARD_WORDS_HPP

#include <optional>
#include <roio/sim/board.hpp>
#include <roio/text.hpp>
#include <string>
#include <string_view>

namespace roio::sim_tool {

struct BoardWord {
  std::string name;  ///< Empty: none given.
  sim::BoardKind kind = sim::BoardKind::uno;
  std::string kind_word;  ///< As it was written.
  std::string file;       ///< An ELF file or a sketch.
};
/// "[NAME:]BOARD=FILE", BOARD one of uno, nano (which is an uno), leonardo, micro (which is a
/// leonardo) and mega.
Parsed<BoardWord> parse_board_word(std::string_view text);

/// "[NAME:]VALUE": "arm:9", or "9" for all boards.
struct NamedValue {
  std::optional<std::string> name;  ///< None: all boards.
  std::string value;
};
NamedValue split_named_value(std::string_view text);

/// A pin as one says it: "4" or "D4", "A0"; "d4" and "a0", too.
struct PinName {
  bool analog = false;  ///< The pin of analog input `number`.
  int number = 0;
};
Parsed<PinName> parse_pin_name(std::string_view text);
/// Arduino's number of it.
/// @throws std::invalid_argument: the board has no such pin.
int number_of(sim::BoardKind kind, const PinName& pin);

/// A whole number, decimal digits alone.
Parsed<std::uint32_t> parse_whole_number(std::string_view text, std::uint32_t smallest,
                                         std::uint32_t largest);
/// Seconds with up to 12 decimals ("0.25"), above 0, at most 1,000,000.
Parsed<sim::SimTime> parse_seconds(std::string_view text);

}  // namespace roio::sim_tool

#endif
