#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <roio/sim/serial_pty.hpp>
#include <system_error>

namespace roio::sim {
namespace {

// As much is kept waiting for the board; the rest stays in the terminal, where its writer sees it.
constexpr std::size_t ahead = 256;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

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

}  // namespace

class SerialPty::Link : public std::enable_shared_from_this<SerialPty::Link> {
 public:
  Link(CanBus& bus, Board& board, int uart, SimTime interval)
      : bus_(bus),
        board_(board),
        uart_(uart),
        interval_(interval),
        master_(
            checked(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), "posix_openpt")),
        path_(slave_of(master_.get())),
        // Kept open, so that the terminal stays raw, and stays, when programs come and go.
        slave_(checked(::open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC), path_.c_str())) {
    termios settings{};
    checked(::tcgetattr(slave_.get(), &settings), "tcgetattr");
    ::cfmakeraw(&settings);
    checked(::tcsetattr(slave_.get(), TCSANOW, &settings), "tcsetattr");
  }

  void look() {
    const std::size_t waiting = board_.serial_waiting(uart_);
    std::array<std::uint8_t, ahead> bytes{};
    const std::size_t room = waiting < ahead ? ahead - waiting : 0;
    const ssize_t count = room > 0 ? ::read(master_.get(), bytes.data(), room) : 0;
    if (count > 0) {
      board_.serial_write(uart_, std::span(bytes).first(static_cast<std::size_t>(count)));
    }
    bus_.after(interval_, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) {
        self->look();
      }
    });
  }

  void put(std::uint8_t byte) {
    while (::write(master_.get(), &byte, 1) != 1) {
      if (errno != EINTR) {
        ++lost_;
        return;
      }
    }
  }

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  CanBus& bus_;
  Board& board_;
  int uart_;
  SimTime interval_;
  Descriptor master_;
  std::string path_;
  Descriptor slave_;
  std::uint64_t lost_ = 0;
};

SerialPty::SerialPty(CanBus& bus, Board& board, int uart, SimTime interval)
    : link_(std::make_shared<Link>(bus, board, uart, interval)), board_(board), uart_(uart) {
  board.on_serial(uart, [link = link_](std::uint8_t byte) { link->put(byte); });
  link_->look();
}

SerialPty::~SerialPty() {
  board_.on_serial(uart_, nullptr);
}

const std::string& SerialPty::path() const {
  return link_->path();
}
std::uint64_t SerialPty::lost() const {
  return link_->lost();
}

}  // namespace roio::sim
