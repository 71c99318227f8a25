#include "top/keys.hpp"

#include <array>
#include <utility>

namespace roio::cli {
namespace {

constexpr std::array<std::pair<char, Action>, 17> letters{{
    {'q', Action::quit},
    {'Q', Action::quit},
    {'s', Action::sort},
    {'r', Action::reverse},
    {' ', Action::pause},
    {'p', Action::pause},
    {'c', Action::clear},
    {'h', Action::help},
    {'?', Action::help},
    {'k', Action::line_up},
    {'j', Action::line_down},
    {'b', Action::page_up},
    {'f', Action::page_down},
    {'g', Action::to_first},
    {'G', Action::to_last},
    {'<', Action::to_first},
    {'>', Action::to_last},
}};

// ESC [ LETTER, or ESC O LETTER.
constexpr std::array<std::pair<char, Action>, 4> arrows{{
    {'A', Action::line_up},
    {'B', Action::line_down},
    {'H', Action::to_first},
    {'F', Action::to_last},
}};

// ESC [ NUMBER ~
constexpr std::array<std::pair<unsigned, Action>, 6> numbered{{
    {1, Action::to_first},
    {4, Action::to_last},
    {5, Action::page_up},
    {6, Action::page_down},
    {7, Action::to_first},
    {8, Action::to_last},
}};

template <typename Table, typename Key>
void look_up(const Table& table, Key key, std::vector<Action>& actions) {
  for (const auto& [name, action] : table) {
    if (name == key) {
      actions.push_back(action);
    }
  }
}

constexpr char escape = '\033';
constexpr unsigned largest_number = 999;

}  // namespace

std::vector<Action> KeyReader::feed(std::string_view bytes) {
  std::vector<Action> actions;
  for (const char byte : bytes) {
    take(byte, actions);
  }
  return actions;
}

void KeyReader::take(char byte, std::vector<Action>& actions) {
  if (byte == escape) {  // wherever it comes, something begins
    state_ = State::escape;
    return;
  }
  switch (state_) {
    case State::plain:
      look_up(letters, byte, actions);
      break;
    case State::escape:
      number_ = 0;
      state_ = byte == '[' || byte == 'O' ? State::sequence : State::plain;
      break;
    case State::sequence:
      take_sequence(byte, actions);
      break;
  }
}

void KeyReader::take_sequence(char last, std::vector<Action>& actions) {
  if (last >= '0' && last <= '9' && number_ <= largest_number) {
    number_ = number_ * 10 + static_cast<unsigned>(last - '0');
    return;
  }
  if (last == ';') {  // modifiers follow, which make no difference
    return;
  }
  state_ = State::plain;
  if (last == '~') {
    look_up(numbered, number_, actions);
  } else {
    look_up(arrows, last, actions);
  }
}

}  // namespace roio::cli
