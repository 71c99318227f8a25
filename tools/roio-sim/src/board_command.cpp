#include "board_command.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "board_words.hpp"

namespace roio::sim_tool {
namespace {

constexpr double supply_volts = 5;
constexpr std::array<std::string_view, 9> verbs{"press",  "hold",  "release", "pin", "analog",
                                                "serial", "reset", "unplug",  "plug"};
constexpr const char* verb_list =
    "press, hold, release, pin, analog, serial, reset, unplug or plug";

constexpr std::string_view blanks = " \t\r\n";

// Takes the first word off the text.
std::string_view take_word(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) {
    text = {};
    return {};
  }
  text.remove_prefix(begin);
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

ParseError expected(const std::string& what, std::string_view found) {
  return {"expected " + what + (found.empty() ? "" : ", found " + quote(found)), 0};
}

Parsed<double> parse_volts(std::string_view word) {
  const bool in_volts = word.ends_with('V');
  const std::string_view digits = in_volts ? word.substr(0, word.size() - 1) : word;
  double value = 0;
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, value, std::chars_format::fixed);
  if (error != std::errc() || end != last || value < 0 || value > (in_volts ? supply_volts : 1)) {
    return expected("0..1 (0.5 is the middle) or volts such as 2.5V, 0..5", word);
  }
  return in_volts ? value : value * supply_volts;
}

Parsed<Action> parse_analog(std::string_view& rest) {
  const std::string_view channel_word = take_word(rest);
  const auto pin = parse_pin_name(channel_word);
  if (!pin || !pin->analog) {
    return expected("an analog input such as A0", channel_word);
  }
  const auto volts = parse_volts(take_word(rest));
  if (!volts) {
    return volts.error();
  }
  return Action(SetAnalog{pin->number, *volts});
}

Parsed<Action> parse_set_pin(std::string_view& rest) {
  const auto pin = parse_pin_name(take_word(rest));
  if (!pin) {
    return pin.error();
  }
  const std::string_view level = take_word(rest);
  if (level != "high" && level != "low" && level != "open") {
    return expected("high, low or open", level);
  }
  return Action(SetPin{*pin, level == "open" ? std::nullopt : std::optional(level == "high")});
}

Parsed<Action> parse_button(std::string_view verb, std::string_view& rest) {
  const auto pin = parse_pin_name(take_word(rest));
  if (!pin) {
    return pin.error();
  }
  if (verb == "press") {
    return Action(Press{*pin});
  }
  return Action(SetPin{*pin, verb == "hold" ? std::optional(false) : std::nullopt});
}

// "serial" or "serial1"; the text is all that follows one blank.
Parsed<Action> parse_serial(std::string_view verb, std::string_view& rest) {
  constexpr std::string_view word = "serial";
  Serial serial;
  if (verb != word) {
    const auto uart = parse_whole_number(verb.substr(word.size()), 0, 3);
    if (!uart) {
      return expected("serial, or serial0 to serial3", verb);
    }
    serial.uart = static_cast<int>(*uart);
  }
  rest.remove_prefix(rest.empty() ? 0 : 1);
  serial.text = std::exchange(rest, {});
  if (serial.text.ends_with('\r')) {
    serial.text.pop_back();
  }
  return Action(std::move(serial));
}

Parsed<Action> parse_plug(bool in, std::string_view& rest) {
  const std::string_view cable = take_word(rest);
  if (!cable.empty() && cable != "serial") {
    return expected("nothing more, or serial", cable);
  }
  return Action(Plug{in, cable.empty() ? Cable::chip : Cable::terminal});
}

Parsed<Action> parse_board_action(std::string_view verb, std::string_view& rest) {
  if (verb == "press" || verb == "hold" || verb == "release") {
    return parse_button(verb, rest);
  }
  if (verb == "pin") {
    return parse_set_pin(rest);
  }
  if (verb == "analog") {
    return parse_analog(rest);
  }
  if (verb.starts_with("serial")) {
    return parse_serial(verb, rest);
  }
  if (verb == "reset") {
    return Action(Reset{});
  }
  if (verb == "plug" || verb == "unplug") {
    return parse_plug(verb == "plug", rest);
  }
  return expected(verb_list, verb);
}

bool is_verb(std::string_view word) {
  return std::find(verbs.begin(), verbs.end(), word) != verbs.end();
}

constexpr std::array<std::string_view, 5> own_verbs{"quit", "help", "wait", "alone", "together"};

Parsed<Action> parse_own_action(std::string_view verb, std::string_view& rest) {
  // No temporary variants, and one that begins as the largest of these: gcc 12 takes parts of
  // others for uninitialised.
  Action action = Wait{sim::SimTime(0)};
  if (verb == "quit") {
    action.emplace<Quit>();
  } else if (verb == "help") {
    action.emplace<Help>();
  } else if (verb == "wait") {
    const auto time = parse_seconds(take_word(rest));
    if (!time) {
      return time.error();
    }
    std::get<Wait>(action).time = *time;
  } else {
    action.emplace<Alone>().alone = verb == "alone";
  }
  return action;
}

}  // namespace

Parsed<Instruction> parse_instruction(std::string_view line) {
  std::string_view rest = line;
  const std::string_view first = take_word(rest);
  const bool own = std::find(own_verbs.begin(), own_verbs.end(), first) != own_verbs.end();
  if (std::string_view after = rest; !own && !is_verb(take_word(after)) && is_verb(first)) {
    const std::string_view all = line.substr(line.find_first_not_of(blanks));
    return expected("a board's name first: NAME " + std::string(all), "");
  }
  if (std::string_view after = rest; !own && take_word(after).empty()) {
    return expected(std::string("a board's name and ") + verb_list + "; or wait, help or quit",
                    first);
  }
  const auto action =
      own ? parse_own_action(first, rest) : parse_board_action(take_word(rest), rest);
  if (!action) {
    return action.error();
  }
  if (const std::string_view word = take_word(rest); !word.empty()) {
    return expected("nothing more", word);
  }
  return Instruction{own ? "" : std::string(first), *action};
}

const char* const command_help =
    "NAME press PIN            a button to ground, for 0.1 s\n"
    "NAME hold PIN             the same, until NAME release PIN\n"
    "NAME pin PIN high|low|open\n"
    "NAME analog A0 VALUE      0..1, or volts: 2.5V\n"
    "NAME serial TEXT          a line to its serial port (serial1: to UART 1)\n"
    "NAME reset                the reset button\n"
    "NAME unplug, NAME plug    the cable to the CAN chip\n"
    "NAME unplug serial        its terminal (--serial-pty), until NAME plug serial\n"
    "alone                     nobody but the boards is on their bus, until together\n"
    "wait SECONDS              what follows comes so much later\n"
    "quit\n";

}  // namespace roio::sim_tool
