/// Names of a kind as identifiers of a programming language: a kind's author need not know what is
/// a keyword or a macro, somewhere.
#ifndef ROIO_CLI_KIND_NAMES_HPP
#define ROIO_CLI_KIND_NAMES_HPP

#include <initializer_list>
#include <set>
#include <string>
#include <string_view>

namespace roio::cli {

/// "servo-arm" -> "servo_arm". What has capitals alone, as macros have, is written small: "LOW" ->
/// "low". A keyword of C++ or a macro of an Arduino's or the PC's libraries gets a '_' behind it,
/// what begins with a digit an 'n' before it.
std::string identifier(std::string_view name);

/// The same for a type: "button-state" -> "ButtonState".
std::string type_identifier(std::string_view name);

/// The same for what stands beside everything that the C library and Arduino declare.
std::string global_identifier(std::string_view name);

/// Identifiers of one scope, no two alike.
class Scope {
 public:
  Scope() = default;
  Scope(std::initializer_list<std::string_view> taken) : taken_(taken.begin(), taken.end()) {}

  /// @return `wanted`, or where another has it, "wanted_2", "wanted_3"...
  /// @param longest in characters; what is longer is cut off.
  std::string add(const std::string& wanted, std::size_t longest = 100);

 private:
  std::set<std::string, std::less<>> taken_;
};

}  // namespace roio::cli

#endif
