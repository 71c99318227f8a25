#include "robot/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <roio/parts/fd.hpp>
#include <system_error>

#include "robot/limits.hpp"
#include "robot/source.hpp"

namespace roio::robot_file {
namespace {

ParseError file_error(const std::filesystem::path& file, const std::string& what) {
  return {shown_name(file.string()) + ": " + what, 0};
}

ParseError system_error(const std::filesystem::path& file) {
  return file_error(file, std::generic_category().message(errno));
}

/// One byte more than the limit is enough to see that it is passed.
bool read_all(int fd, std::string& out) {
  std::array<char, 16384> part{};
  while (out.size() <= max_text) {
    const ssize_t count = ::read(fd, part.data(), part.size());
    if (count == 0) {
      return true;
    }
    if (count < 0 && errno != EINTR) {
      return false;
    }
    out.append(part.data(), count < 0 ? 0 : static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

Parsed<std::string> read_file(const std::filesystem::path& file) {
  // A pipe without a writer would keep open() waiting.
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!fd || ::fstat(fd.get(), &status) != 0) {
    return system_error(file);
  }
  if (!S_ISREG(status.st_mode)) {
    return file_error(file, S_ISDIR(status.st_mode) ? "a folder; expected a file"
                                                    : "no ordinary file; expected one");
  }
  std::string text;
  if (!read_all(fd.get(), text)) {
    return system_error(file);
  }
  if (text.size() > max_text) {
    return file_error(file,
                      "more than " + std::to_string(max_text) + " bytes; expected at most so many");
  }
  return text;
}

}  // namespace roio::robot_file
