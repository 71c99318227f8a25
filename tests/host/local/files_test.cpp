// Where a local bus is in the file system, what it finds there, and what is taken away from it.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <roio.hpp>

#include "process.hpp"
#include "rig.hpp"

namespace roio {
namespace {

using namespace std::chrono_literals;
using test::becomes;
using test::Peer;
using test::refusal;
using test::RuntimeFolder;
using test::unique_name;

mode_t mode_of(const std::filesystem::path& path) {
  struct stat status {};
  EXPECT_EQ(::lstat(path.c_str(), &status), 0) << path;
  return status.st_mode & ACCESSPERMS;
}

TEST(LocalBusFiles, ARelativeFolderIsRefused) {
  const RuntimeFolder folder("buses");
  ::setenv("ROIO_RUNTIME_DIR", "buses", 1);
  EXPECT_EQ(refusal("local:robot"),
            "ROIO_RUNTIME_DIR \"buses\": expected a path that begins with /");
  EXPECT_FALSE(std::filesystem::exists("buses"));
}

TEST(LocalBusFiles, IsForThisUserAlone) {
  const RuntimeFolder folder(unique_name());
  const auto bus = open("local:mine");
  EXPECT_EQ(mode_of(folder.path()), mode_t{0700});
  EXPECT_EQ(mode_of(folder.path() / "mine.sock"), mode_t{0600});
}

TEST(LocalBusFiles, AFolderOpenToOthersIsRefused) {
  const RuntimeFolder folder(unique_name());
  std::filesystem::create_directory(folder.path());
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  EXPECT_EQ(refusal("local:mine"), folder.path().string() +
                                       ": expected a folder of this user's with mode 0700; "
                                       "ROIO_RUNTIME_DIR can name another: local buses are for one "
                                       "user alone");
}

TEST(LocalBusFiles, AFolderThatIsALinkIsRefused) {
  const RuntimeFolder folder(unique_name());
  std::filesystem::create_symlink("/tmp", folder.path());
  EXPECT_NE(refusal("local:mine"), "(opened)");
}

TEST(LocalBusFiles, APathTooLongForASocketIsAnError) {
  const RuntimeFolder folder(unique_name() + std::string(80, 'x'));
  EXPECT_NE(refusal("local:mine").find("File name too long"), std::string::npos);
}

TEST(LocalBusFiles, TheSocketOfAKilledHubIsCleanedUp) {
  const RuntimeFolder folder(unique_name());
  {
    Peer hub({"hold", "local:stale"});
    ASSERT_EQ(hub.line(), "open");
    hub.kill();
  }
  ASSERT_TRUE(std::filesystem::exists(folder.path() / "stale.sock"));
  { const auto bus = open("local:stale"); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "neither socket nor lock is left";
}

TEST(LocalBusFiles, AFileInTheSocketsPlaceIsReplaced) {
  const RuntimeFolder folder(unique_name());
  std::filesystem::create_directory(folder.path());
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  std::ofstream(folder.path() / "odd.sock") << "no socket";
  EXPECT_EQ(refusal("local:odd"), "(opened)");
}

TEST(LocalBusFiles, WhoseFilesAreRemovedComesTogetherAgain) {
  const RuntimeFolder folder(unique_name());
  const auto first = open("local:cleaned");
  const auto second = open("local:cleaned");
  std::filesystem::remove_all(folder.path());
  const auto newcomer = open("local:cleaned");
  EXPECT_TRUE(becomes(*newcomer, 2)) << "there is one bus of that name";
  ASSERT_EQ(first->send(Frame{1, FrameKind::standard, 0, {}}, 30s), Result::ok);
  Received received{};
  EXPECT_EQ(second->receive(received, 30s), Result::ok);
  EXPECT_EQ(newcomer->receive(received, 30s), Result::ok);
  EXPECT_GE(first->statistics().outages, 1U);
}

TEST(LocalBusFiles, WithoutItsSocketItComesTogetherAgain) {
  const RuntimeFolder folder(unique_name());
  const auto first = open("local:cleaned");
  std::filesystem::remove(folder.path() / "cleaned.sock");
  const auto newcomer = open("local:cleaned", {.open_timeout = 30s});
  EXPECT_TRUE(becomes(*newcomer, 1));
}

// Its clients have it mapped: were it made shorter, they would die of it.
TEST(LocalBusFiles, AnotherVersionsMemoryIsLeftAlone) {
  const RuntimeFolder folder(unique_name());
  std::filesystem::create_directory(folder.path());
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  const auto lock = folder.path() / "old.lock";
  std::ofstream(lock) << "of another version";
  std::ifstream mapped(lock);
  EXPECT_NO_THROW(open("local:old", {.open_timeout = 30s}));
  std::string text;
  std::getline(mapped, text);
  EXPECT_EQ(text, "of another version");
}

}  // namespace
}  // namespace roio
