#include "record/record_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <string_view>
#include <system_error>
#include <utility>

#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

constexpr mode_t permissions = 0666;  // less the umask

[[noreturn]] void fail(const std::string& name, int error) {
  throw Failure(name + ": " + std::generic_category().message(error));
}

[[noreturn]] void fail_as_there(const std::string& name) {
  throw Failure(name + ": is there already; expected another name, or --force to overwrite it");
}

bool is_regular(const std::string& name) {
  struct stat status {};
  return ::stat(name.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

// -1 with errno. A pipe waits here for its reader.
int open_to_write(const std::string& name, int flags) {
  return ::open(name.c_str(), O_WRONLY | O_CLOEXEC | flags, permissions);
}

int open_new(const std::string& name) {
  return open_to_write(name, O_CREAT | O_EXCL);
}

const char* ending_of(Form form) {
  switch (form) {
    case Form::csv:
      return ".csv";
    case Form::pcap:
      return ".pcap";
    default:
      return ".log";
  }
}

std::string dated_stem() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::localtime_r(&now, &parts);
  std::array<char, sizeof "roio-YYYY-mm-dd_HHMMSS" + 8> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "roio-%Y-%m-%d_%H%M%S", &parts)};
}

}  // namespace

void RecordFile::refuse_existing(const std::string& name) {
  if (is_regular(name)) {
    fail_as_there(name);
  }
}

std::optional<RecordFile> RecordFile::create(const std::string& name, bool force) {
  int fd = open_new(name);
  if (fd < 0 && errno == EEXIST) {
    if (!force) {
      refuse_existing(name);
    }
    do {
      fd = open_to_write(name, O_TRUNC);
    } while (fd < 0 && errno == EINTR && Interrupt::signal() == 0);
  }
  if (fd < 0 && Interrupt::signal() != 0) {
    return std::nullopt;
  }
  if (fd < 0) {
    fail(name, errno);
  }
  return RecordFile(fd, name);
}

std::optional<RecordFile> RecordFile::create_dated(Form form) {
  constexpr int most_a_second = 1000;
  const std::string stem = dated_stem();
  const std::string ending = ending_of(form);
  std::string name = stem + ending;
  int fd = open_new(name);
  for (int number = 2; fd < 0 && errno == EEXIST && number < most_a_second; ++number) {
    name = stem;
    name += "-" + std::to_string(number);
    name += ending;
    fd = open_new(name);
  }
  if (fd < 0) {
    fail(name, errno);
  }
  return RecordFile(fd, name);
}

RecordFile::RecordFile(int fd, std::string name) : fd_(fd), name_(std::move(name)) {}

RecordFile::RecordFile(RecordFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), name_(std::move(other.name_)), size_(other.size_) {}

RecordFile::~RecordFile() {
  if (fd_ >= 0) {
    ::close(fd_);
  }
}

void RecordFile::write(Buffer& records) {
  std::string_view left(records.data(), records.size());
  while (!left.empty()) {
    const ssize_t written = ::write(fd_, left.data(), left.size());
    if (written >= 0) {
      left.remove_prefix(static_cast<std::size_t>(written));
      continue;
    }
    if (errno == EPIPE) {
      throw BrokenPipe{};
    }
    if (errno != EINTR) {  // records are finished even when a signal came
      const int error = errno;
      // Of a pipe there is nothing to be taken back.
      [[maybe_unused]] const int ignored = ::ftruncate(fd_, static_cast<off_t>(size_));
      fail(name_, error);
    }
  }
  size_ += records.size();
  records.clear();
}

void RecordFile::close() {
  if (::close(std::exchange(fd_, -1)) != 0 && errno != EINTR) {
    fail(name_, errno);
  }
}

}  // namespace roio::cli
