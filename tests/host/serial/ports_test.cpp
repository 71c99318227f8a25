/// Which serial ports are looked at, and what is said of such as cannot be had.
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <roio/bridge.hpp>
#include <roio/error.hpp>
#include <string>
#include <system_error>

#include "serial/ports.hpp"

namespace roio::serial {
namespace {

class Ports : public testing::Test {
 protected:
  Ports() : folder_("/tmp/roio-ports-" + std::to_string(::getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~Ports() override {
    ::unsetenv("ROIO_SERIAL_PORTS");
    std::filesystem::remove_all(folder_);
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    const std::string path = folder_ + '/' + name;
    std::ofstream(path).put('\n');
    return path;
  }
  static std::vector<std::string> ports(const std::string& setting) {
    ::setenv("ROIO_SERIAL_PORTS", setting.c_str(), 1);
    return likely_ports();
  }
  const std::string folder_;
};

using Paths = std::vector<std::string>;

TEST_F(Ports, AColonSeparatesWhereASlashFollows) {
  const std::string by_path = file("pci-0000:00:14.0-usb-0:2:1.0");
  const std::string plain = file("ttyS3");
  EXPECT_EQ(ports(by_path), Paths{by_path});
  EXPECT_EQ(ports(by_path + ':' + plain), (Paths{by_path, plain}));
  EXPECT_EQ(ports(plain + ':' + by_path + ':'), (Paths{by_path, plain})) << "sorted";
  EXPECT_EQ(ports(folder_ + "/pci-*:1.?:" + plain), (Paths{by_path, plain})) << "a pattern";
  EXPECT_EQ(ports(plain + "::" + plain), Paths{plain}) << "once each, and nothing between them";
  EXPECT_EQ(ports(""), Paths{}) << "none at all";
}

TEST_F(Ports, WhatIsNotThereIsTold) {
  const std::string missing = folder_ + "/ttyACM0";
  EXPECT_EQ(ports(missing), Paths{missing});
  EXPECT_EQ(ports(folder_ + "/ttyACM*"), Paths{}) << "a pattern may well match nothing";
  ::setenv("ROIO_SERIAL_PORTS", missing.c_str(), 1);
  const auto found = find_bridges();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, missing);
  EXPECT_EQ(found[0].why_not, "no such serial port");
}

TEST_F(Ports, RelativePathsAreRefused) {
  for (const auto& [setting, shown] :
       {std::pair{"ttyACM0", "ttyACM0"}, std::pair{"/dev/null:/dev/zero,x", ""},
        std::pair{"~/tty:/dev/null", "~/tty"}}) {
    try {
      ports(setting);
      EXPECT_STREQ(shown, "") << setting;
    } catch (const std::system_error& error) {
      EXPECT_EQ(error.code(), Errc::relative_path);
      EXPECT_EQ(error.what(), "ROIO_SERIAL_PORTS \"" + std::string(shown) +
                                  "\": expected a path that begins with /");
    }
  }
}

TEST_F(Ports, TheGroupOfAPortIsNamed) {
  const std::string port = file("port");
  struct stat status {};
  ASSERT_EQ(::stat(port.c_str(), &status), 0);
  ASSERT_EQ(::chmod(port.c_str(), 0660), 0);
  const group* const entry = ::getgrgid(status.st_gid);
  ASSERT_NE(entry, nullptr);
  const std::string name = entry->gr_name;
  EXPECT_EQ(how_to_be_permitted(port),
            "join its group " + name + ": `sudo usermod -aG " + name + " $USER`, and log in again");
  for (const mode_t mode : {0600U, 0640U, 0620U}) {
    ASSERT_EQ(::chmod(port.c_str(), mode), 0);
    EXPECT_EQ(how_to_be_permitted(port), "only its owner may; a udev rule gives it a group");
  }
}

}  // namespace
}  // namespace roio::serial
