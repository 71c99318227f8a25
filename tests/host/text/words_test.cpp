#include <gtest/gtest.h>

#include "parsing.hpp"

namespace roio {
namespace {

using test::verdict;

TEST(Words, PrioritiesComeBack) {
  for (const char* text : {"urgent", "normal"}) {
    const auto parsed = parse_priority(text);
    ASSERT_EQ(verdict(parsed), "ok") << text;
    EXPECT_STREQ(to_string(*parsed), text);
  }
  EXPECT_EQ(*parse_priority("urgent"), Priority::urgent);
  EXPECT_EQ(verdict(parse_priority("Urgent")), R"(priority "Urgent": expected urgent or normal)");
  EXPECT_EQ(verdict(parse_priority("")), R"(priority "": expected urgent or normal)");
}

TEST(Words, ClassesComeBack) {
  for (const char* text : {"message", "system", "stream", "reserved"}) {
    const auto parsed = parse_class(text);
    ASSERT_EQ(verdict(parsed), "ok") << text;
    EXPECT_STREQ(to_string(*parsed), text);
  }
  EXPECT_EQ(*parse_class("stream"), MessageClass::stream);
  EXPECT_EQ(verdict(parse_class("messages")),
            R"(class "messages": expected message, system, stream or reserved)");
}

}  // namespace
}  // namespace roio
