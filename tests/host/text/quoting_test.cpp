// How an error line shows text that came from outside: one line, whatever it was.
#include <gtest/gtest.h>

#include "parsing.hpp"

namespace roio {
namespace {

struct QuotingCase {
  const char* why;
  std::string text;
  const char* shown;
};

TEST(Quoting, ShowsWhatWasThere) {
  const QuotingCase cases[] = {
      {"plain", "abc ~", R"("abc ~")"},
      {"quote and backslash", R"(a"b\c)", R"("a\"b\\c")"},
      {"the common control characters", "\n\r\t", R"("\n\r\t")"},
      {"other control characters", std::string("\0\x01\x1B\x7F", 4), R"("\x00\x01\x1B\x7F")"},
      {"two-byte UTF-8", "\xC2\xA0\xDF\xBF", "\"\xC2\xA0\xDF\xBF\""},
      {"C1 control in UTF-8", "\xC2\x80\xC2\x9F", R"("\xC2\x80\xC2\x9F")"},
      {"three bytes", "\xE0\xA0\x80\xE2\x82\xAC\xED\x9F\xBF\xEF\xBF\xBD",
       "\"\xE0\xA0\x80\xE2\x82\xAC\xED\x9F\xBF\xEF\xBF\xBD\""},
      {"four bytes", "\xF0\x90\x80\x80\xF3\xA0\x80\x81\xF4\x8F\xBF\xBF",
       "\"\xF0\x90\x80\x80\xF3\xA0\x80\x81\xF4\x8F\xBF\xBF\""},
      {"stray continuation", "a\x80z", R"("a\x80z")"},
      {"overlong two bytes", "\xC0\x80\xC1\xBF", R"("\xC0\x80\xC1\xBF")"},
      {"overlong three bytes", "\xE0\x9F\xBF", R"("\xE0\x9F\xBF")"},
      {"overlong four bytes", "\xF0\x8F\xBF\xBF", R"("\xF0\x8F\xBF\xBF")"},
      {"surrogate", "\xED\xA0\x80", R"("\xED\xA0\x80")"},
      {"above U+10FFFF", "\xF4\x90\x80\x80\xF5", R"("\xF4\x90\x80\x80\xF5")"},
      {"cut short", "\xE2\x82", R"("\xE2\x82")"},
      {"second byte missing in the middle", "\xC3z", R"("\xC3z")"},
      {"48 bytes", std::string(48, 'x'), R"("xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx")"},
      {"49 bytes", std::string(49, 'x'),
       R"("xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx..." (49 bytes))"},
      {"a character across the cut stays whole", std::string(47, 'x') + "\xC3\xA4yz",
       "\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\xC3\xA4...\" (51 bytes)"},
  };
  for (const QuotingCase& row : cases) {
    EXPECT_EQ(test::verdict(parse_priority(row.text)),
              std::string("priority ") + row.shown + ": expected urgent or normal")
        << row.why;
  }
}

}  // namespace
}  // namespace roio
