/// Line: one line of a screen, with colours, never wider than it may be.
#ifndef ROIO_CLI_LINE_HPP
#define ROIO_CLI_LINE_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace roio::cli {

enum class Style : std::uint8_t { plain, strong, dim, warning, changed, bar };

class Line {
 public:
  /// @param width in columns; what goes beyond is cut off.
  Line(std::size_t width, bool colour) : width_(width), colour_(colour) {}

  /// Text in UTF-8, a column for each character; a control character shows as '?'.
  void add(std::string_view text, Style style = Style::plain);
  /// The same in a field: cut to it with a '+' at its end, or filled up with spaces.
  void add_left(std::string_view text, std::size_t field, Style style = Style::plain);
  /// The same, the spaces first.
  void add_right(std::string_view text, std::size_t field, Style style = Style::plain);
  /// Spaces up to a column.
  void fill(std::size_t column, Style style = Style::plain);

  [[nodiscard]] std::size_t used() const { return used_; }
  [[nodiscard]] std::size_t left() const { return width_ - used_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::size_t width_;
  bool colour_;
  std::size_t used_ = 0;
  std::string text_;
};

/// In columns.
std::size_t width_of(std::string_view text);

}  // namespace roio::cli

#endif
