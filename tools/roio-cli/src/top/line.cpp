#include "top/line.hpp"

#include <algorithm>
#include <iterator>

namespace roio::cli {
namespace {

std::string_view code(Style style) {
  switch (style) {
    case Style::strong:
      return "\033[1m";
    case Style::dim:
      return "\033[2m";
    case Style::warning:
      return "\033[1;31m";
    case Style::changed:
      return "\033[1;33m";
    case Style::bar:
      return "\033[7m";
    case Style::plain:
      break;
  }
  return "";
}

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

bool is_control(char byte) {
  return static_cast<unsigned char>(byte) < 0x20U || byte == 0x7F;
}

/// As much of a text as has room in so many columns.
std::string_view first_columns(std::string_view text, std::size_t columns) {
  std::size_t end = 0;
  while (end < text.size() && (columns > 0 || continues_character(text[end]))) {
    columns -= continues_character(text[end]) ? 0U : 1U;
    ++end;
  }
  return text.substr(0, end);
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char byte) { return !continues_character(byte); }));
}

void Line::add(std::string_view text, Style style) {
  text = first_columns(text, left());
  if (text.empty()) {
    return;
  }
  const bool coloured = colour_ && style != Style::plain;
  text_ += coloured ? code(style) : "";
  std::transform(text.begin(), text.end(), std::back_inserter(text_),
                 [](char byte) { return is_control(byte) ? '?' : byte; });
  text_ += coloured ? "\033[0m" : "";
  used_ += width_of(text);
}

void Line::add_left(std::string_view text, std::size_t field, Style style) {
  const std::size_t width = width_of(text);
  if (width > field) {
    add(std::string(first_columns(text, field > 0 ? field - 1 : 0)) + (field > 0 ? "+" : ""),
        style);
  } else {
    add(std::string(text) + std::string(field - width, ' '), style);
  }
}

void Line::add_right(std::string_view text, std::size_t field, Style style) {
  const std::size_t width = width_of(text);
  add(std::string(width < field ? field - width : 0, ' '));
  add_left(text, std::min(width, field), style);
}

void Line::fill(std::size_t column, Style style) {
  if (column > used_) {
    add(std::string(column - used_, ' '), style);
  }
}

}  // namespace roio::cli
