#include "board/pty_terminal.hpp"

// Not termios.h: only the kernel's own structure has rates such as 250,000.
#include <asm/termbits.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace roio::sim {
namespace {

int checked(int result, const char* what) {
  if (result < 0) {
    throw std::system_error(errno, std::generic_category(), what);
  }
  return result;
}

std::string slave_of(int master) {
  checked(::grantpt(master), "grantpt");
  checked(::unlockpt(master), "unlockpt");
  std::array<char, 64> name{};
  if (const int error = ::ptsname_r(master, name.data(), name.size()); error != 0) {
    throw std::system_error(error, std::generic_category(), "ptsname");
  }
  return name.data();
}

// The rate of a terminal that nobody has set. No AVR of 16 MHz goes as slow as that, so that no
// program means it.
constexpr tcflag_t unset_rate = B134;
constexpr speed_t unset_bps = 134;

// As cfmakeraw() does.
void make_raw(int terminal) {
  termios2 settings{};
  checked(::ioctl(terminal, TCGETS2, &settings), "TCGETS2");
  settings.c_iflag &=
      ~static_cast<tcflag_t>(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
  settings.c_oflag &= ~static_cast<tcflag_t>(OPOST);
  settings.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSIZE | PARENB | CBAUD | CIBAUD);
  settings.c_cflag |= static_cast<tcflag_t>(CS8) | unset_rate;
  settings.c_ospeed = unset_bps;
  settings.c_ispeed = unset_bps;
  checked(::ioctl(terminal, TCSETS2, &settings), "TCSETS2");
}

std::size_t count_of(ssize_t result) {
  return result > 0 ? static_cast<std::size_t>(result) : 0;
}

}  // namespace

PtyTerminal::Descriptor::Descriptor(int fd, const char* what) : fd_(checked(fd, what)) {}
PtyTerminal::Descriptor::~Descriptor() {
  ::close(fd_);
}

PtyTerminal::PtyTerminal()
    : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), "posix_openpt"),
      path_(slave_of(master_.get())),
      slave_(::open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC), path_.c_str()) {
  make_raw(slave_.get());
}

std::optional<double> PtyTerminal::bitrate_bps() const {
  termios2 settings{};
  checked(::ioctl(slave_.get(), TCGETS2, &settings), "TCGETS2");
  const speed_t rate = settings.c_ospeed;
  const bool is_set = rate != unset_bps && rate != 0;
  return is_set ? std::optional<double>(rate) : std::nullopt;
}

std::size_t PtyTerminal::read(std::span<std::uint8_t> room) {
  return count_of(::read(master_.get(), room.data(), room.size()));
}

std::size_t PtyTerminal::write(std::span<const std::uint8_t> bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const auto rest = bytes.subspan(written);
    const ssize_t count = ::write(master_.get(), rest.data(), rest.size());
    if (count <= 0 && errno != EINTR) {
      break;
    }
    written += count_of(count);
  }
  return written;
}

}  // namespace roio::sim
