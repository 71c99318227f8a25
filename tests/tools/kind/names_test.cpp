// Names of a kind as identifiers: what means something elsewhere, and what is alike in C++ alone.
#include "kind/names.hpp"

#include <gtest/gtest.h>

namespace roio::cli {
namespace {

struct Row {
  const char* why;
  const char* name;
  const char* identifier;
  const char* type;
};

TEST(Names, Identifiers) {
  const Row rows[] = {
      {"a word", "angles", "angles", "Angles"},
      {"words", "button-state", "button_state", "ButtonState"},
      {"words with '_'", "button_state", "button_state", "ButtonState"},
      {"words as camels", "buttonState", "buttonState", "ButtonState"},
      {"two '-': two '_' are the compiler's", "a--b", "a_b", "AB_"},
      {"'-' at the end", "a-", "a_", "A_"},
      {"'-' at the end of a longer one", "left-", "left_", "Left"},
      {"capitals alone, as macros have", "LOW", "low", "Low"},
      {"capitals and digits", "PORTB1", "portb1", "Portb1"},
      {"one letter: types have small letters, too", "x", "x", "X_"},
      {"one capital", "X", "x", "X_"},
      {"a capital among others", "aB", "aB", "AB_"},
      {"a keyword", "default", "default_", "Default"},
      {"a keyword of C++20", "requires", "requires_", "Requires"},
      {"a keyword in another spelling", "and", "and_", "And"},
      {"a macro of glibc", "errno", "errno_", "Errno"},
      {"a macro of gcc", "linux", "linux_", "Linux"},
      {"a macro of Arduino's core", "acosf", "acosf_", "Acosf"},
      {"an interrupt", "SPI_STC_vect", "SPI_STC_vect_", "SPISTCVect"},
      {"a type of the header", "uint8_t", "uint8_t_", "Uint8T"},
      {"a digit first, of a choice", "1", "n1", "n1_"},
      {"a digit first", "2nd-gear", "n2nd_gear", "n2ndGear"},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.why);
    EXPECT_EQ(identifier(row.name), row.identifier);
    EXPECT_EQ(type_identifier(row.name), row.type);
  }
}

TEST(Names, BesideAllThatArduinoDeclares) {
  EXPECT_EQ(global_identifier("servo-arm"), "servo_arm");
  EXPECT_EQ(global_identifier("roio"), "roio_") << "what a sketch calls its node";
  EXPECT_EQ(global_identifier("random"), "random_") << "a function";
  EXPECT_EQ(global_identifier("while"), "while_") << "a keyword";
  EXPECT_EQ(global_identifier("Servo"), "Servo_") << "a class";
  EXPECT_EQ(global_identifier("Serial"), "Serial_") << "an object";
  EXPECT_EQ(global_identifier("daylight"), "daylight_") << "a variable of the C library";
  EXPECT_EQ(global_identifier("timezone"), "timezone_") << "the same";
}

TEST(Names, NoTwoAlikeInAScope) {
  Scope scope{"length"};
  EXPECT_EQ(scope.add("a_b"), "a_b");
  EXPECT_EQ(scope.add("a_b"), "a_b_2");
  EXPECT_EQ(scope.add("a_b_2"), "a_b_2_2");
  EXPECT_EQ(scope.add("a_b"), "a_b_3");
  EXPECT_EQ(scope.add("length"), "length_2");
}

TEST(Names, CutOffAndStillDifferent) {
  Scope scope;
  EXPECT_EQ(scope.add("abcdef", 6), "abcdef");
  EXPECT_EQ(scope.add("abcdefg", 6), "abcd_2");
  EXPECT_EQ(scope.add("abcdefgh", 6), "abcd_3");
}

}  // namespace
}  // namespace roio::cli
