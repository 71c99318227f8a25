// ISO 8859-1: its last character and the first that it does not have.
#include "kind/latin1.hpp"

#include <gtest/gtest.h>

namespace roio::cli {
namespace {

struct Row {
  const char* why;
  const char* utf8;
  const char* latin1;
  std::size_t replaced;
};

TEST(Latin1, EachCharacterOrAQuestionMark) {
  const Row rows[] = {
      {"nothing", "", "", 0},
      {"ASCII to its end", "a~\x7F", "a~\x7F", 0},
      {"U+0080, two bytes", "\xC2\x80", "\x80", 0},
      {"U+00B0, degrees", "\xC2\xB0", "\xB0", 0},
      {"U+00FF, the last", "\xC3\xBF", "\xFF", 0},
      {"U+0100, one past", "\xC4\x80", "?", 1},
      {"U+2126, three bytes", "a\xE2\x84\xA6z", "a?z", 1},
      {"U+1F600, four bytes", "\xF0\x9F\x98\x80", "?", 1},
      {"several", "\xC4\x80\xC2\xB5\xC4\x80", "?\xB5?", 2},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.why);
    const Latin1 found = to_latin1(row.utf8);
    EXPECT_EQ(found.text, row.latin1);
    EXPECT_EQ(found.replaced, row.replaced);
  }
}

}  // namespace
}  // namespace roio::cli
