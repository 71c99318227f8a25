#ifndef ROIO_TESTS_PARSING_HPP
#define ROIO_TESTS_PARSING_HPP

#include <cstddef>
#include <roio/text.hpp>
#include <string>

namespace roio::test {

/// What a parser said: its error line, or "ok" (which no error line is).
template <typename T>
std::string verdict(const Parsed<T>& parsed) {
  return parsed ? "ok" : parsed.error().message;
}

/// A text that a parser must refuse, in which words and where.
struct Refusal {
  const char* why;
  std::string text;
  std::string message;
  std::size_t offset;
};

}  // namespace roio::test

#endif
