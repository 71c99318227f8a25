#ifndef ROIO_TESTS_ROBOT_REFUSALS_HPP
#define ROIO_TESTS_ROBOT_REFUSALS_HPP

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace roio::test {

/// A row of refusals/kind.txt and robot.txt: a file that is not right, and what is said of it.
/// schema_test.py reads the same tables, for what the schemas say.
struct BrokenFile {
  std::string why;
  std::string error;
  std::string text;
};

inline std::vector<BrokenFile> broken_files(const std::string& name) {
  std::ifstream file(std::string(ROIO_SOURCE_DIR "/tests/host/robot/refusals/") + name);
  std::vector<BrokenFile> rows;
  bool in_text = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("== ")) {
      rows.push_back({line.substr(3), "", ""});
      in_text = false;
    } else if (in_text) {
      rows.back().text += line + '\n';
    } else if (line == "--") {
      in_text = true;
    } else if (line.starts_with("error: ")) {
      rows.back().error = line.substr(7);
    }
  }
  for (BrokenFile& row : rows) {
    row.text.pop_back();  // the line end that the table adds
  }
  EXPECT_GT(rows.size(), 50U) << name;
  return rows;
}

}  // namespace roio::test

#endif
