/// What the keys of `roio-cli top` mean: bytes from a terminal go in, actions come out.
#ifndef ROIO_CLI_KEYS_HPP
#define ROIO_CLI_KEYS_HPP

#include <cstdint>
#include <string_view>
#include <vector>

namespace roio::cli {

enum class Action : std::uint8_t {
  quit,
  sort,
  reverse,
  pause,
  clear,
  help,
  line_up,
  line_down,
  page_up,
  page_down,
  to_first,
  to_last,
};

/// Keeps the beginning of a key's sequence (ESC [ A) until the rest comes. Never more than some
/// bytes: a sequence that is none, or too long, is passed over.
class KeyReader {
 public:
  std::vector<Action> feed(std::string_view bytes);

 private:
  void take(char byte, std::vector<Action>& actions);
  void take_sequence(char last, std::vector<Action>& actions);

  enum class State : std::uint8_t { plain, escape, sequence };
  State state_ = State::plain;
  unsigned number_ = 0;  // of a sequence such as ESC [ 5 ~
};

}  // namespace roio::cli

#endif
