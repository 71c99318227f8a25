#include "serial/termios.hpp"

#include <asm/termbits.h>
#include <sys/ioctl.h>

namespace roio::serial {
namespace {

void put_rate(termios2& settings, std::uint32_t rate_bps) {
  settings.c_cflag &= ~static_cast<tcflag_t>(CBAUD | (CBAUD << IBSHIFT));
  settings.c_cflag |= static_cast<tcflag_t>(BOTHER | (BOTHER << IBSHIFT));
  settings.c_ispeed = rate_bps;
  settings.c_ospeed = rate_bps;
}

}  // namespace

bool make_raw(int fd, std::uint32_t rate_bps) {
  termios2 settings{};
  if (::ioctl(fd, TCGETS2, &settings) != 0) {
    return false;
  }
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  put_rate(settings, rate_bps);
  return ::ioctl(fd, TCSETS2, &settings) == 0;
}

bool set_line_rate(int fd, std::uint32_t rate_bps) {
  termios2 settings{};
  if (::ioctl(fd, TCGETS2, &settings) != 0) {
    return false;
  }
  put_rate(settings, rate_bps);
  return ::ioctl(fd, TCSETS2, &settings) == 0;
}

}  // namespace roio::serial
