/// What every fuzz target shares. A target is one file that defines check() and asks require() for
/// the properties that must hold whatever the input was.
#ifndef ROIO_TESTS_FUZZ_TARGET_HPP
#define ROIO_TESTS_FUZZ_TARGET_HPP

#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <roio/text.hpp>
#include <string_view>

namespace roio::fuzz {

/// The target's own: called with each input, of any bytes, by libfuzzer_entry.cpp or
/// replay_main.cpp.
void check(std::string_view input);

/// Ends the program when a property does not hold, as a sanitizer would.
inline void require(bool holds, const char* property) {
  if (!holds) {
    std::cerr << "does not hold: " << property << '\n';
    std::abort();
  }
}

/// An error is one short line of printable text, and points into the input.
inline void require_good_error(const ParseError& error, std::string_view input) {
  constexpr std::size_t longest = 1000;
  require(!error.message.empty() && error.message.size() <= longest, "an error line of 1..1000");
  for (const char character : error.message) {
    require(static_cast<unsigned char>(character) >= ' ' && character != '\x7F',
            "no control character in an error line");
  }
  require(error.offset <= input.size(), "an error's offset is within the input");
}

}  // namespace roio::fuzz

#endif
