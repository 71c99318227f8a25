// In a program whose locale has a decimal comma, the JSON parser hands on numbers with that comma.
#include <gtest/gtest.h>

#include "json/events.hpp"

namespace roio {
namespace {

TEST(JsonLocale, DecimalCommaOfTheParserIsReadAsAPoint) {
  JsonEvents events;
  std::string name = "timestamp";
  ASSERT_TRUE(events.start_object(1));
  ASSERT_TRUE(events.key(name));
  ASSERT_TRUE(events.number_float(1.25, "1,25"));
  EXPECT_EQ(events.fields().timestamp, Timestamp(std::chrono::milliseconds(1250)));
}

TEST(JsonLocale, DecimalCommaOfTheParserIsShownAsAPoint) {
  JsonEvents events;
  std::string name = "address";
  ASSERT_TRUE(events.start_object(1));
  ASSERT_TRUE(events.key(name));
  ASSERT_FALSE(events.number_float(1.5, "1,5"));
  ASSERT_TRUE(events.error());
  EXPECT_EQ(events.error()->message, R"(JSON field "address": 1.5; expected an integer 0..254)");
}

}  // namespace
}  // namespace roio
