#ifndef ROIO_ROBOT_SYNTAX_HPP
#define ROIO_ROBOT_SYNTAX_HPP

#include <optional>
#include <string_view>

#include "robot/source.hpp"
#include "robot/value.hpp"

namespace roio::robot_file {

/// How far a parser was.
struct SyntaxState {
  std::optional<Value::Type> open;  ///< The innermost that is: an array or an object.
  bool needs_colon = false;         ///< A name has come, and its value has not.
  bool is_complete = false;         ///< Behind the whole document.
};

/// Says what stands where a text is no JSON, and what is expected there.
/// @param fault where the parser stopped, which may be within a word.
[[noreturn]] void refuse_syntax(const Source& source, std::size_t fault, std::string_view place,
                                const SyntaxState& state);

}  // namespace roio::robot_file

#endif
