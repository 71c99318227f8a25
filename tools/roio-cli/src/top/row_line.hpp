/// The rows of `roio-cli top` in columns, as many as there is room for.
#ifndef ROIO_CLI_ROW_LINE_HPP
#define ROIO_CLI_ROW_LINE_HPP

#include <cstddef>
#include <span>
#include <string>

#include "top/row_text.hpp"

namespace roio::cli {

/// Which columns there are, and how wide. Source, destination, message, rate and value always are;
/// on a wider screen age, class, priority and the number of frames come in, in that order.
struct RowLayout {
  /// @param texts of the rows that are seen: columns of names are as wide as these need.
  RowLayout(std::span<const RowText> texts, std::size_t columns);

  std::size_t columns;
  std::size_t address = 6;
  std::size_t message = 3;
  std::size_t value = 0;
  bool narrow;  ///< No arrow, and one space between columns.
  bool with_age = false;
  bool with_class = false;
  bool with_priority = false;
  bool with_frames = false;

  [[nodiscard]] const char* gap() const { return narrow ? " " : "  "; }
  [[nodiscard]] const char* arrow() const { return narrow ? " " : " -> "; }
};

std::string title_line(const RowLayout& layout, bool colour);
std::string row_line(const RowLayout& layout, const TrafficRow& row, const RowText& text,
                     bool colour);

}  // namespace roio::cli

#endif
