// Where local buses are in the file system.
#include "local/place.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <system_error>

namespace roio::local {
namespace {

class Folders : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(run_);
    std::filesystem::permissions(run_, std::filesystem::perms::owner_all);
  }
  void TearDown() override { std::filesystem::remove_all(base_); }

  const std::string user_ = std::to_string(::geteuid());
  const std::string base_ =
      std::filesystem::temp_directory_path() / ("roio-folders-" + std::to_string(::getpid()));
  const std::string run_ = base_ + "/run/" + user_;
  const std::string of_login_ = run_ + "/roio";
  const std::string of_tmp_ = base_ + "/roio-" + user_;
};

TEST_F(Folders, TheOneThatIsChosenAlone) {
  EXPECT_EQ(folders("/some/where", base_ + "/run", base_), std::vector<std::string>{"/some/where"});
  EXPECT_THROW(folders("some/where", base_ + "/run", base_), std::system_error);
}

TEST_F(Folders, TheOneOfTheLoginAndBehindItTheOneForAll) {
  EXPECT_EQ(folders(nullptr, base_ + "/run", base_),
            (std::vector<std::string>{of_login_, of_tmp_}));
  EXPECT_EQ(folders("", base_ + "/run", base_), (std::vector<std::string>{of_login_, of_tmp_}));
}

TEST_F(Folders, NoLoginNoFolderOfIt) {
  std::filesystem::remove(run_);
  EXPECT_EQ(folders(nullptr, base_ + "/run", base_), std::vector<std::string>{of_tmp_});
}

TEST_F(Folders, AFolderOpenToOthersIsNotTheLogins) {
  std::filesystem::permissions(run_, std::filesystem::perms::all);
  EXPECT_EQ(folders(nullptr, base_ + "/run", base_), std::vector<std::string>{of_tmp_});
}

TEST(Processes, AStoppedOneIsKnown) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::pause();
    ::_exit(0);
  }
  EXPECT_FALSE(is_stopped(child));
  ::kill(child, SIGSTOP);
  int status = 0;
  ::waitpid(child, &status, WUNTRACED);
  EXPECT_TRUE(is_stopped(child));
  EXPECT_EQ(describe_process(child).rfind("process " + std::to_string(child) + " (", 0), 0U);
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  EXPECT_FALSE(is_stopped(child));
}

}  // namespace
}  // namespace roio::local
