#include "top/row_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "top/line.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t narrow_below = 60;
constexpr std::size_t widest_address = 16;
constexpr std::size_t widest_message = 16;
constexpr std::size_t rate_width = 6;
constexpr std::size_t age_width = 6;
constexpr std::size_t class_width = 7;
constexpr std::size_t priority_width = 6;
constexpr std::size_t frames_width = 9;
constexpr std::size_t byte_width = 3;  // two digits, and a space or the star of a change
constexpr std::size_t bytes_width = byte_width * max_data_length;

/// Bytes in hexadecimal. What changed is coloured, and has a star behind it for those who see no
/// colours.
void add_bytes(Line& line, std::size_t room, const TrafficRow& row, Style style) {
  const std::size_t length = row.last.length;
  const bool all = length * byte_width <= room;
  const std::size_t shown = all ? length : (room - 1) / byte_width;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool changed = ((row.changed >> i) & 1U) != 0;
    line.add(fmt::format("{:02X}{}", row.last.data[i], changed ? '*' : ' '),
             changed ? Style::changed : style);
  }
  if (!all) {
    line.add("+", style);
  }
}

struct Cell {
  bool shown;
  std::string text;
  std::size_t width;
  bool to_the_right = false;
};

/// Everything before the value.
void add_cells(Line& line, const RowLayout& layout, std::initializer_list<Cell> cells,
               Style style) {
  for (const Cell& cell : cells) {
    if (!cell.shown) {
      continue;
    }
    line.add(layout.gap());
    if (cell.to_the_right) {
      line.add_right(cell.text, cell.width, style);
    } else {
      line.add_left(cell.text, cell.width, style);
    }
  }
  line.add(layout.gap());
}

Style style_of(const TrafficRow& row, const RowText& text) {
  return row.silent || !text.is_message ? Style::dim
         : text.priority == "urgent"    ? Style::strong
                                        : Style::plain;
}

void add_before_value(Line& line, const RowLayout& layout, const RowText& text,
                      const std::string& frames, Style style) {
  add_cells(line, layout,
            {{layout.with_priority, text.priority, priority_width},
             {layout.with_class, text.message_class, class_width},
             {true, text.message, layout.message},
             {layout.with_frames, frames, frames_width, true},
             {true, text.rate, rate_width, true},
             {layout.with_age, text.age, age_width, true}},
            style);
}

}  // namespace

RowLayout::RowLayout(std::span<const RowText> texts, std::size_t all_columns)
    : columns(all_columns), narrow(all_columns < narrow_below) {
  for (const RowText& text : texts) {
    address = std::max({address, width_of(text.source), width_of(text.destination)});
    message = std::max(message, width_of(text.message));
    value = std::max(value, width_of(text.fields));
  }
  address = std::min(address, widest_address);
  message = std::min(message, widest_message);
  const std::size_t between = narrow ? 1 : 2;
  std::size_t used =
      2 * address + (narrow ? 1 : 4) + between + message + between + rate_width + between;
  const std::size_t wanted = std::max(value, bytes_width);
  for (const auto& [shown, width] :
       std::initializer_list<std::pair<bool*, std::size_t>>{{&with_age, age_width},
                                                            {&with_class, class_width},
                                                            {&with_priority, priority_width},
                                                            {&with_frames, frames_width}}) {
    if (used + between + width + wanted > columns) {
      break;
    }
    *shown = true;
    used += between + width;
  }
  value = columns > used ? columns - used : 0;
}

std::string title_line(const RowLayout& layout, bool colour) {
  Line line(layout.columns, colour);
  line.add_left("source", layout.address, Style::strong);
  line.add(layout.narrow ? " " : "    ");
  line.add_left(layout.narrow ? "dest" : "to", layout.address, Style::strong);
  RowText titles;
  titles.priority = "prio";
  titles.message_class = "class";
  titles.message = "msg";
  titles.rate = "rate/s";
  titles.age = "age";
  add_before_value(line, layout, titles, "frames", Style::strong);
  line.add("value", Style::strong);
  return line.text();
}

std::string row_line(const RowLayout& layout, const TrafficRow& row, const RowText& text,
                     bool colour) {
  const Style style = style_of(row, text);
  Line line(layout.columns, colour);
  line.add_left(text.source, layout.address, style);
  line.add(text.is_message ? layout.arrow() : layout.narrow ? " " : "    ", style);
  line.add_left(text.destination, layout.address, style);
  add_before_value(line, layout, text, std::to_string(row.frames), style);
  if (is_remote(row.last.kind)) {
    line.add_left("remote request", layout.value, style);
  } else if (!text.fields.empty()) {
    line.add_left(text.fields, layout.value, style);
  } else if (layout.value > 0) {
    add_bytes(line, layout.value, row, style);
  }
  return line.text();
}

}  // namespace roio::cli
