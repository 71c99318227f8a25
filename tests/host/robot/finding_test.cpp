// Where a robot's file is found from, and its kinds.
#include <gtest/gtest.h>

#include <roio/robot.hpp>
#include <string>

#include "folder.hpp"
#include "parsing.hpp"

namespace roio {
namespace {

using test::verdict;
namespace fs = std::filesystem;

constexpr std::string_view robot_text =
    R"({"roio": 1, "name": "r", "places": {"arm": {"address": "0.2", "kind": "arm"}}})";

std::string kind_text(const std::string& description) {
  return R"({"roio": 1, "kind": "arm", "description": ")" + description + "\"}";
}

class Finding : public test::RobotFolder {
 protected:
  /// The description of the arm's kind, which says where it was found.
  static std::string found(const LoadOptions& options = {}) {
    const auto robot = load_robot("robot.json", options);
    return robot ? robot->places.at(0).kind->description : robot.error().message;
  }
};

TEST_F(Finding, AKindInTheOrderOfTheDocument) {
  write("robot.json", robot_text);
  const LoadOptions options{{"first", "second"}};
  ::setenv("XDG_DATA_HOME", (path() / "home").c_str(), 1);
  ::setenv("XDG_DATA_DIRS",
           ((path() / "a").string() + "::relative:" + (path() / "b").string()).c_str(), 1);
  const std::string missing = found(options);
  EXPECT_EQ(missing,
            "robot.json:1: places.arm.kind: no file arm.kind.json in ., kinds, first, second, " +
                (path() / "home/roio/kinds").string() + ", " + (path() / "a/roio/kinds").string() +
                ", " + (path() / "b/roio/kinds").string());
  // From the last place to the first: each goes before those that are there already.
  for (const char* folder :
       {"b/roio/kinds", "a/roio/kinds", "home/roio/kinds", "second", "first", "kinds", "."}) {
    write(fs::path(folder) / "arm.kind.json", kind_text(folder));
    EXPECT_EQ(found(options), folder);
  }
}

TEST_F(Finding, AKindBesideTheRobotNotWhereTheProgramStands) {
  write("there/robot.json", robot_text);
  write("arm.kind.json", kind_text("here"));
  EXPECT_FALSE(load_robot("there/robot.json"));
  write("there/kinds/arm.kind.json", kind_text("there"));
  const auto robot = load_robot("there/robot.json");
  ASSERT_EQ(verdict(robot), "ok");
  EXPECT_EQ(robot->places[0].kind->description, "there");
}

TEST_F(Finding, ABrokenKindIsNotPassedOver) {
  write("robot.json", robot_text);
  write("kinds/arm.kind.json", kind_text("good"));
  write("arm.kind.json", "{\n\"roio\": 2}");
  EXPECT_EQ(found(),
            "arm.kind.json:2: roio: 2; expected 1, the version of the format that is read here");
  write("arm.kind.json", R"({"roio": 1, "kind": "leg"})");
  EXPECT_EQ(found(), R"(arm.kind.json:1: kind: "leg"; expected "arm", as the file is called)");
  fs::remove("arm.kind.json");
  fs::create_directory("arm.kind.json");
  EXPECT_EQ(found(), "arm.kind.json: a folder; expected a file");
  fs::remove("arm.kind.json");
  fs::create_symlink("nowhere", "arm.kind.json");
  EXPECT_EQ(found(), "good") << "a link that leads nowhere is no file";
}

TEST_F(Finding, TheRobotInThisFolderOrAbove) {
  fs::create_directories("a/b/c");
  const fs::path here = fs::canonical(".");
  EXPECT_EQ(find_robot_file("/proc/self"), std::nullopt);
  write("robot.json", robot_text);
  write("a/robot.json", robot_text);
  const struct {
    const char* why;
    fs::path folder;
    fs::path file;
  } rows[] = {
      {"in it", "a", "a/robot.json"},
      {"a blank folder is this one", ".", "robot.json"},
      {"above it", "a/b/c", "a/robot.json"},
      {"with a slash behind", "a/b/c/", "a/robot.json"},
      {"the nearest", "a/b/../b", "a/robot.json"},
      {"absolute", here / "a/b", "a/robot.json"},
      {"of a folder that is not there", "a/none/none", "a/robot.json"},
  };
  for (const auto& row : rows) {
    const auto found = find_robot_file(row.folder);
    ASSERT_TRUE(found) << row.why;
    EXPECT_EQ(fs::canonical(*found), here / row.file) << row.why;
  }
}

TEST_F(Finding, AFileOfThatNameThatIsNotOurs) {
  fs::create_directories("a/b");
  write("robot.json", robot_text);
  const struct {
    const char* why;
    std::string text;
    bool is_ours;
  } rows[] = {
      {"another program's", R"({"links": [{"name": "roio"}]})", false},
      {"our word as a value", R"({"made with": "roio"})", false},
      {"not at the top", R"({"a": {"roio": 1}})", false},
      {"a list", R"(["roio"])", false},
      {"empty", "", false},
      {"JSON lines", "{\"type\": 1}\n{\"type\": 2}\n", false},
      {"ours, of another version", R"({"roio": 2})", true},
      {"ours, and nothing in it", R"({"roio": null})", true},
      {"ours, with a slip of the pen: that is to be said", R"({"roio": 1,})", true},
      {"ours, cut off", "{\n  \"roio\": 1,\n  \"name\": \"r", true},
      {"too large to be read: that is to be said", std::string(1048577, ' '), true},
  };
  for (const auto& row : rows) {
    write("a/robot.json", row.text);
    const auto found = find_robot_file("a/b");
    ASSERT_TRUE(found) << row.why;
    EXPECT_EQ(found->parent_path().filename() == "a", row.is_ours) << row.why;
  }
}

TEST_F(Finding, AFileThatCannotBeRead) {
  fs::create_directories("a/robot.json");
  write("robot.json", robot_text);
  EXPECT_EQ(find_robot_file("a"), fs::absolute("robot.json")) << "a folder is passed over";
  fs::remove("a/robot.json");
  fs::create_symlink("nowhere", "a/robot.json");
  EXPECT_EQ(find_robot_file("a"), fs::absolute("robot.json")) << "a link that leads nowhere, too";
  fs::remove("a/robot.json");
  write("a/robot.json", robot_text);
  fs::permissions("a/robot.json", fs::perms::none);
  // root may read all the same
  EXPECT_EQ(find_robot_file("a"), fs::absolute("a/robot.json"));
}

}  // namespace
}  // namespace roio
