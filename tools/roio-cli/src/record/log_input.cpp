#include "record/log_input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "program/exit_status.hpp"
#include "program/interrupt.hpp"

namespace roio::cli {
namespace {

[[noreturn]] void fail(const std::string& name) {
  throw Failure(name + ": " + std::generic_category().message(errno));
}

int open_input(const std::string& name) {
  if (name == "-") {
    return STDIN_FILENO;
  }
  int fd = -1;
  do {  // a pipe waits here for its writer
    fd = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  } while (fd < 0 && errno == EINTR && Interrupt::signal() == 0);
  if (fd < 0 && Interrupt::signal() != 0) {
    throw Interrupted{};
  }
  if (fd < 0) {
    fail(name);
  }
  return fd;
}

}  // namespace

LogInput::LogInput(const std::string& name)
    : name_(name == "-" ? "standard input" : name), fd_(open_input(name)), reader_(fd_, name_) {
  struct stat status {};
  if (::fstat(fd_, &status) == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    refuse_capture();
  }
}

LogInput::~LogInput() {
  if (fd_ != STDIN_FILENO) {
    ::close(fd_);
  }
}

// Else it would be refused line by line.
void LogInput::refuse_capture() const {
  constexpr std::array<std::array<unsigned char, 4>, 5> magics{{
      {0x4D, 0x3C, 0xB2, 0xA1},  // pcap, in nanoseconds and in microseconds, of either byte order
      {0xD4, 0xC3, 0xB2, 0xA1},
      {0xA1, 0xB2, 0x3C, 0x4D},
      {0xA1, 0xB2, 0xC3, 0xD4},
      {0x0A, 0x0D, 0x0D, 0x0A},  // pcapng
  }};
  std::array<unsigned char, 4> begin{};
  const bool whole = ::pread(fd_, begin.data(), begin.size(), 0) == 4;
  if (whole && std::find(magics.begin(), magics.end(), begin) != magics.end()) {
    throw Failure(name_ + ": a capture; expected a log, as record and candump -l write it");
  }
}

bool LogInput::fill() {
  if (at_end_ || !Interrupt::wait_readable(fd_)) {
    return false;
  }
  at_end_ = !reader_.fill();
  // The last line may have no end.
  return true;
}

void LogInput::begin_again() {
  if (::lseek(fd_, 0, SEEK_SET) != 0) {
    fail(name_);
  }
  reader_ = LineReader(fd_, name_);
  at_end_ = false;
}

std::optional<double> LogInput::share() const {
  const off_t at = ::lseek(fd_, 0, SEEK_CUR);
  if (!size_ || *size_ == 0 || at < 0) {
    return std::nullopt;
  }
  return std::min(1.0, static_cast<double>(at) / static_cast<double>(*size_));
}

}  // namespace roio::cli
