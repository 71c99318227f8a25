#ifndef ROIO_TESTS_ROBOT_FOLDER_HPP
#define ROIO_TESTS_ROBOT_FOLDER_HPP

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace roio::test {

/// A folder of a test's own in which it stands, so that files are called in errors as they are
/// here; and no kinds of this machine's are found.
class RobotFolder : public ::testing::Test {
 public:
  RobotFolder(const RobotFolder&) = delete;
  RobotFolder& operator=(const RobotFolder&) = delete;
  ~RobotFolder() override {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(path_);
  }

 protected:
  RobotFolder() : before_(std::filesystem::current_path()) {
    std::string name = (std::filesystem::temp_directory_path() / "roio-robot-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    std::filesystem::current_path(path_);
    ::setenv("XDG_DATA_DIRS", "/nowhere", 1);
    ::setenv("XDG_DATA_HOME", "/nowhere", 1);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  static void write(const std::filesystem::path& file, std::string_view text) {
    if (file.has_parent_path()) {
      std::filesystem::create_directories(file.parent_path());
    }
    std::ofstream(file, std::ios::binary) << text;
  }

 private:
  std::filesystem::path before_;
  std::filesystem::path path_;
};

inline const std::filesystem::path source_dir = ROIO_SOURCE_DIR;

}  // namespace roio::test

#endif
