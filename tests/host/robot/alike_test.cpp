#include "robot/alike.hpp"

#include <gtest/gtest.h>

#include <string>

namespace roio::robot_file {
namespace {

TEST(Alike, Nearest) {
  const std::vector<std::string> names = {"shoulder", "elbow", "hand", "x", "maximum"};
  const struct {
    const char* why;
    std::string word;
    std::string name;
  } rows[] = {
      {"a letter less", "sholder", "shoulder"},
      {"a letter more", "elboww", "elbow"},
      {"another letter", "hend", "hand"},
      {"two swapped", "hnad", "hand"},
      {"capitals", "ELBOW", "elbow"},
      {"two slips in eight letters", "sholdr", "shoulder"},
      {"three are too many", "shldr", "none"},
      {"two in four are too many", "hxxd", "none"},
      {"the beginning", "max", "maximum"},
      {"two letters are no beginning", "ma", "none"},
      {"one letter for another", "y", "none"},
      {"nothing", "", "none"},
      {"nothing like it", "voltage", "none"},
      {"64 letters", std::string(64, 's'), "none"},
      {"65 letters", std::string(65, 's'), "none"},
      {"very many letters", std::string(1000000, 's'), "none"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(nearest(row.word, names).value_or("none"), row.name) << row.why;
  }
  EXPECT_EQ(nearest("sholder", {"shelter", "shoulder"}), "shoulder") << "the nearest of several";
  EXPECT_EQ(nearest("a", {}), std::nullopt);
}

TEST(Alike, Lists) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"a"}), "a");
  EXPECT_EQ(listed({"a", "b"}), "a, b");
  const std::vector<std::string> ten = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
  EXPECT_EQ(listed(ten), "a, b, c, d, e, f, g, h, i, j");
  std::vector<std::string> more = ten;
  more.insert(more.end(), {"k", "l"});
  EXPECT_EQ(listed(more), "a, b, c, d, e, f, g, h, i, j and 2 more");
}

}  // namespace
}  // namespace roio::robot_file
