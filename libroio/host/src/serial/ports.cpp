#include "serial/ports.hpp"

#include <glob.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
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
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return paths;
}

std::vector<std::string> all_matches(std::string_view patterns) {
  std::vector<std::string> paths;
  while (!patterns.empty()) {
    const std::size_t end = std::min(patterns.find(':'), patterns.size());
    if (end > 0) {
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

}  // namespace roio::serial
