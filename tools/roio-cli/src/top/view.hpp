/// What stands on the screen of `roio-cli top`: a pure function of what is known, how the user
/// wants to see it, and the size of the screen.
///
///   local:robot  error-active  500000 bit/s
///   load  42.1 %, peak  97.3 %, 3120 frames/s, 210500 bit/s
///   123456 frames, 0 lost, 0 errors, 0 times bus-off, 0 outages
///   source    to      prio    class    msg  rate/s     age  value
///   0.10   -> 0.2     normal  message  [3]    10.0   0.1 s  5A 2D*00
///   ...
///   q quit  s sort: source  r reverse  p pause  c clear  h help      rows 1-18 of 45
#ifndef ROIO_CLI_VIEW_HPP
#define ROIO_CLI_VIEW_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "form/labels.hpp"
#include "top/keys.hpp"
#include "top/snapshot.hpp"

namespace roio::cli {

enum class SortKey : std::uint8_t { source, destination, rate, age, frames };

struct Size {
  std::size_t columns = 80;
  std::size_t lines = 24;
};

/// How the user wants to see it.
struct View {
  SortKey sort = SortKey::source;
  bool reversed = false;
  std::size_t first_row = 0;
  bool paused = false;
  bool help = false;
};

/// How many rows a screen has room for.
std::size_t rows_on_screen(Size size);

/// What a key makes of a view. quit, clear and what pause keeps are the caller's.
/// @param rows there are.
View after(View view, Action action, std::size_t rows, Size size);

/// The rows in the order that the view has them.
std::vector<TrafficRow> sorted(std::vector<TrafficRow> rows, const View& view);

/// @return size.lines lines at most, each of size.columns columns at most.
/// @param colour without it, a changed byte has a star behind it all the same, and nothing else is
///        told by colour alone.
std::vector<std::string> draw(const Snapshot& snapshot, const View& view, const Labels& labels,
                              Size size, bool colour);

}  // namespace roio::cli

#endif
