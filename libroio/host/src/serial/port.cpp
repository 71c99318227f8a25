#include "serial/port.hpp"

#include <fcntl.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <roio/error.hpp>
#include <system_error>

#include "serial/ports.hpp"
#include "serial/termios.hpp"

namespace roio::serial {
namespace {

std::error_code reason(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
    case ENODEV:
    case ENXIO:
      return Errc::no_such_port;
    case EACCES:
    case EPERM:
      return Errc::port_not_permitted;
    case EBUSY:
      return Errc::port_in_use;
    case EISDIR:
    case ENOTTY:
      return Errc::not_a_port;
    default:
      return {error, std::generic_category()};
  }
}

[[noreturn]] void fail(const std::string& name, std::error_code code) {
  throw std::system_error(code, name);
}

/// A driver such as slcand's has taken it.
bool has_line_discipline(int fd) {
  int discipline = N_TTY;
  return ::ioctl(fd, TIOCGETD, &discipline) == 0 && discipline != N_TTY;
}

bool is_pseudo_terminal(int fd) {
  constexpr unsigned first_major = 136;  // UNIX98_PTY_SLAVE_MAJOR
  constexpr unsigned last_major = 143;
  struct stat status {};
  if (::fstat(fd, &status) != 0) {
    return false;
  }
  const unsigned number = major(status.st_rdev);
  return number >= first_major && number <= last_major;
}

/// Against programs that look for no lock. It ends when nobody has the port open any more: that is,
/// for a pseudo terminal, when its maker says so, so there it is left out.
void exclude_others(int fd) {
  if (!is_pseudo_terminal(fd)) {
    static_cast<void>(::ioctl(fd, TIOCEXCL));
  }
}

/// An FTDI chip otherwise keeps what it has received for up to 16 ms.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (::ioctl(fd, TIOCGSERIAL, &settings) == 0) {
    settings.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
    static_cast<void>(::ioctl(fd, TIOCSSERIAL, &settings));
  }
}

bool would_wait() {
  return errno == EAGAIN || errno == EINTR;
}

}  // namespace

SerialPort::SerialPort(const std::string& path, const std::string& name, std::uint32_t rate_bps)
    : fd_(ParentsFd::of([&] {
        return UniqueFd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
      })),
      rate_bps_(rate_bps) {
  if (!fd_) {
    const std::error_code code = reason(errno);
    fail(code == Errc::port_not_permitted ? name + " (" + how_to_be_permitted(path) + ")" : name,
         code);
  }
  if (::isatty(fd()) == 0) {
    fail(name, Errc::not_a_port);
  }
  if (::flock(fd(), LOCK_EX | LOCK_NB) != 0) {
    fail(name, errno == EWOULDBLOCK ? Errc::port_in_use : reason(errno));
  }
  if (has_line_discipline(fd())) {
    fail(name, Errc::port_in_use);
  }
  exclude_others(fd());
  if (!make_raw(fd(), rate_bps)) {
    fail(name, reason(errno));
  }
  ask_for_low_latency(fd());
  ::tcflush(fd(), TCIOFLUSH);
}

bool SerialPort::set_rate(std::uint32_t rate_bps) {
  ::tcflush(fd(), TCOFLUSH);
  rate_bps_ = rate_bps;
  return set_line_rate(fd(), rate_bps);
}

std::optional<std::size_t> SerialPort::read(std::span<std::uint8_t> bytes) const {
  const ssize_t count = ::read(fd(), bytes.data(), bytes.size());
  if (count > 0) {
    return static_cast<std::size_t>(count);
  }
  return count < 0 && would_wait() ? std::optional<std::size_t>(0) : std::nullopt;
}

std::optional<std::size_t> SerialPort::write(std::span<const std::uint8_t> bytes) const {
  const ssize_t count = ::write(fd(), bytes.data(), bytes.size());
  if (count >= 0) {
    return static_cast<std::size_t>(count);
  }
  return would_wait() ? std::optional<std::size_t>(0) : std::nullopt;
}

}  // namespace roio::serial
