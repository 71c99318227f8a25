#include "serial/ports.hpp"

#include <glob.h>
#include <grp.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <string_view>
#include <system_error>

namespace roio::serial {
namespace {

namespace fs = std::filesystem;

// Who sells Arduinos, their clones, and the chips in them: Arduino (two companies of the name),
// QinHeng (CH340), FTDI, Silicon Labs (CP210x), SparkFun, Adafruit.
constexpr std::array<std::string_view, 7> vendors{"2341", "2a03", "1a86", "0403",
                                                  "10c4", "1b4f", "239a"};
constexpr const char* usual_ports = "/dev/ttyACM*:/dev/ttyUSB*";
constexpr const char* ports_variable = "ROIO_SERIAL_PORTS";

std::vector<std::string> matches(const std::string& pattern) {
  std::vector<std::string> paths;
  glob_t found{};
  // A name that is no pattern stands for itself: a port that is not there is worth a word.
  if (::glob(pattern.c_str(), GLOB_NOMAGIC, nullptr, &found) == 0) {
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return paths;
}

// Names below /dev/serial/by-path hold colons, and never one before a slash.
std::size_t end_of_first(std::string_view patterns) {
  std::size_t end = patterns.find(':');
  while (end < patterns.size() && end + 1 < patterns.size() && patterns[end + 1] != '/' &&
         patterns[end + 1] != ':') {
    end = patterns.find(':', end + 1);
  }
  return std::min(end, patterns.size());
}

std::vector<std::string> all_matches(std::string_view patterns) {
  std::vector<std::string> paths;
  while (!patterns.empty()) {
    const std::size_t end = end_of_first(patterns);
    if (end > 0) {
      if (patterns.front() != '/') {
        throw std::system_error(Errc::relative_path,
                                std::string(ports_variable) + " " + quote(patterns.substr(0, end)));
      }
      const auto some = matches(std::string(patterns.substr(0, end)));
      paths.insert(paths.end(), some.begin(), some.end());
    }
    patterns.remove_prefix(std::min(end + 1, patterns.size()));
  }
  std::sort(paths.begin(), paths.end());
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  return paths;
}

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// The port's USB device in sysfs: the nearest above it that has a vendor. None: empty.
fs::path usb_device_of(const std::string& path) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  fs::path folder = fs::canonical("/sys/class/tty" / real.filename() / "device", error);
  while (!error && folder.has_relative_path()) {
    if (fs::exists(folder / "idVendor", error)) {
      return folder;
    }
    folder = folder.parent_path();
  }
  return {};
}

bool is_of_likely_vendor(const std::string& path) {
  const fs::path device = usb_device_of(path);
  return !device.empty() && std::find(vendors.begin(), vendors.end(),
                                      first_line(device / "idVendor")) != vendors.end();
}

bool has_open(const fs::path& process, const fs::path& port) {
  std::error_code error;
  for (fs::directory_iterator fd(process / "fd", error), end; !error && fd != end;
       fd.increment(error)) {
    std::error_code closed_meanwhile;
    if (fs::read_symlink(fd->path(), closed_meanwhile) == port) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> likely_ports() {
  if (const char* const wanted = std::getenv(ports_variable)) {
    return all_matches(wanted);
  }
  std::vector<std::string> ports = all_matches(usual_ports);
  std::erase_if(ports, [](const std::string& path) { return !is_of_likely_vendor(path); });
  return ports;
}

std::string product_of(const std::string& path) {
  const fs::path device = usb_device_of(path);
  return device.empty() ? std::string() : first_line(device / "product");
}

bool is_open_anywhere(const std::string& path) {
  std::error_code error;
  const fs::path port = fs::canonical(path, error);
  if (error || !fs::exists("/sys/class/tty" / port.filename(), error)) {
    return false;
  }
  for (fs::directory_iterator process("/proc", error), end; !error && process != end;
       process.increment(error)) {
    if (has_open(process->path(), port)) {
      return true;
    }
  }
  return false;
}

std::string how_to_be_permitted(const std::string& path) {
  constexpr mode_t group_may = S_IRGRP | S_IWGRP;
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || (status.st_mode & group_may) != group_may) {
    return "only its owner may; a udev rule gives it a group";
  }
  const std::string number = std::to_string(status.st_gid);
  group entry{};
  group* found = nullptr;
  std::array<char, 4096> names{};
  static_cast<void>(::getgrgid_r(status.st_gid, &entry, names.data(), names.size(), &found));
  const std::string name = found != nullptr ? found->gr_name : number;
  return "join its group " + name + ": `sudo usermod -aG " + name + " $USER`, and log in again";
}

}  // namespace roio::serial
