#include "board_words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace roio::sim_tool {
namespace {

constexpr std::size_t longest_name = 32;
// First words of commands, and of lines that are about no board.
constexpr std::array<std::string_view, 4> reserved_names{"wait", "quit", "help", "bus"};

constexpr std::uint32_t largest_pin = 99;  // of any board; which it has, the board knows

constexpr std::array<std::pair<std::string_view, sim::BoardKind>, 5> kinds{{
    {"uno", sim::BoardKind::uno},
    {"nano", sim::BoardKind::uno},
    {"leonardo", sim::BoardKind::leonardo},
    {"micro", sim::BoardKind::leonardo},
    {"mega", sim::BoardKind::mega},
}};

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

std::optional<std::string> trouble_with_name(std::string_view name) {
  if (name.empty() || name.size() > longest_name ||
      !std::all_of(name.begin(), name.end(), is_name_character)) {
    return "a name of 1 to " + std::to_string(longest_name) +
           " letters, digits, '.', '_' or '-' before the colon";
  }
  if (std::find(reserved_names.begin(), reserved_names.end(), name) != reserved_names.end()) {
    return "another name than " + quote(name) + ", which is a command's";
  }
  return std::nullopt;
}

ParseError error_in(std::string_view what, std::string_view text, const std::string& expected) {
  return {std::string(what) + " " + quote(text) + ": expected " + expected, 0};
}

}  // namespace

Parsed<BoardWord> parse_board_word(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals + 1 == text.size()) {
    return error_in("board", text, "[NAME:]BOARD=FILE, such as fan:uno=Fan/Fan.ino");
  }
  const std::string_view left = text.substr(0, equals);
  const std::size_t colon = left.find(':');
  BoardWord word;
  if (colon != std::string_view::npos) {
    word.name = left.substr(0, colon);
    if (const auto trouble = trouble_with_name(word.name)) {
      return error_in("board", text, *trouble);
    }
  }
  word.kind_word = colon == std::string_view::npos ? left : left.substr(colon + 1);
  word.file = text.substr(equals + 1);
  const auto* const kind = std::find_if(
      kinds.begin(), kinds.end(), [&](const auto& entry) { return entry.first == word.kind_word; });
  if (kind == kinds.end()) {
    return error_in(
        "board", text,
        "uno, nano, leonardo, micro or mega before the '=', found " + quote(word.kind_word));
  }
  word.kind = kind->second;
  return word;
}

NamedValue split_named_value(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    return {std::nullopt, std::string(text)};
  }
  return {std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

Parsed<PinName> parse_pin_name(std::string_view text) {
  const char kind = text.empty() ? '\0' : text.front();
  const bool analog = kind == 'A' || kind == 'a';
  const bool prefixed = analog || kind == 'D' || kind == 'd';
  const auto number = parse_whole_number(prefixed ? text.substr(1) : text, 0, largest_pin);
  if (!number) {
    return ParseError{"expected a pin such as 4 or A0" +
                          (text.empty() ? std::string() : ", found " + quote(text)),
                      0};
  }
  return PinName{analog, static_cast<int>(*number)};
}

int number_of(sim::BoardKind kind, const PinName& pin) {
  return sim::main_pin(kind, pin.analog ? sim::analog_pin(kind, pin.number) : pin.number);
}

Parsed<std::uint32_t> parse_whole_number(std::string_view text, std::uint32_t smallest,
                                         std::uint32_t largest) {
  std::uint32_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last || value < smallest || value > largest) {
    return ParseError{"expected a whole number " + std::to_string(smallest) + ".." +
                          std::to_string(largest) + ", found " + quote(text),
                      0};
  }
  return value;
}

Parsed<sim::SimTime> parse_seconds(std::string_view text) {
  constexpr double most = 1e6;
  double value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value, std::chars_format::fixed);
  if (error != std::errc() || end != last || !(value > 0) || value > most) {
    return ParseError{
        "expected seconds, above 0 and at most 1000000, such as 0.25, found " + quote(text), 0};
  }
  return std::chrono::duration_cast<sim::SimTime>(std::chrono::duration<double>(value));
}

}  // namespace roio::sim_tool
