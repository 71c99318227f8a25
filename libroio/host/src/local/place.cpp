#include "local/place.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <utility>

namespace roio::local {
namespace {

constexpr int listen_backlog = 128;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void make_private_folder(const std::string& path) {
  if (::mkdir(path.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    fail(path);
  }
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) {
    fail(path);
  }
  constexpr mode_t others = S_IRWXG | S_IRWXO;
  if (!S_ISDIR(status.st_mode) || status.st_uid != ::geteuid() || (status.st_mode & others) != 0) {
    throw std::system_error(Errc::not_permitted,
                            path + ": expected a folder of this user's with mode 0700");
  }
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    fail(path);
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

UniqueFd make_socket() {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd) {
    fail("socket");
  }
  return fd;
}

bool is_file_at(const UniqueFd& fd, const std::string& path) {
  struct stat open {};
  struct stat there {};
  return ::fstat(fd.get(), &open) == 0 && ::stat(path.c_str(), &there) == 0 &&
         open.st_ino == there.st_ino && open.st_dev == there.st_dev;
}

const sockaddr* generic(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

}  // namespace

std::string folder() {
  // Read once at open(); a program that changes its environment from another thread is on its own.
  const char* chosen = std::getenv("ROIO_RUNTIME_DIR");
  if (chosen == nullptr || *chosen == '\0') {
    return "/tmp/roio-" + std::to_string(::geteuid());
  }
  // Programs in different folders would be on different buses of one name, and none would say so.
  if (*chosen != '/') {
    throw std::system_error(Errc::relative_path, "ROIO_RUNTIME_DIR " + quote(chosen));
  }
  return chosen;
}

HubSeat::HubSeat(UniqueFd lock, UniqueFd listener, std::string lock_path, std::string socket_path)
    : lock_(std::move(lock)),
      listener_(std::move(listener)),
      lock_path_(std::move(lock_path)),
      socket_path_(std::move(socket_path)) {}

HubSeat::~HubSeat() {
  // Were the folder emptied meanwhile, what is there now would be another hub's.
  if (lock_ && is_file_at(lock_, lock_path_)) {
    ::unlink(socket_path_.c_str());
    ::unlink(lock_path_.c_str());  // still locked: see Place::claim()
  }
}

Place::Place(const std::string& bus_name) : bus_name_(bus_name), folder_(folder()) {
  make_private_folder(folder_);
  socket_path_ = folder_ + "/" + bus_name + ".sock";
  lock_path_ = folder_ + "/" + bus_name + ".lock";
  static_cast<void>(address_of(socket_path_ + ".new"));  // too long: say so now
}

UniqueFd Place::connect() const {
  UniqueFd fd = make_socket();
  const sockaddr_un address = address_of(socket_path_);
  if (::connect(fd.get(), generic(address), sizeof address) != 0) {
    if (errno == ENOENT || errno == ECONNREFUSED || errno == EAGAIN || errno == EINTR) {
      return {};
    }
    fail("local:" + bus_name_);
  }
  if (!is_same_user(fd.get())) {
    throw std::system_error(Errc::not_permitted, "local:" + bus_name_);
  }
  return fd;
}

std::optional<HubSeat> Place::claim() const {
  make_private_folder(folder_);  // it may have been cleaned away
  UniqueFd lock(::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (!lock) {
    fail(lock_path_);
  }
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK || errno == EINTR) {
      return std::nullopt;
    }
    fail(lock_path_);
  }
  // Who held the lock before may have removed its file since it was opened here: then this lock is
  // on a file that nobody else will find.
  if (!is_file_at(lock, lock_path_)) {
    return std::nullopt;
  }
  // Bound beside its place and moved there: who finds the socket finds it listening.
  UniqueFd listener = make_socket();
  const std::string fresh = socket_path_ + ".new";
  const sockaddr_un address = address_of(fresh);
  ::unlink(fresh.c_str());
  if (::bind(listener.get(), generic(address), sizeof address) != 0 ||
      ::chmod(fresh.c_str(), S_IRUSR | S_IWUSR) != 0 ||
      ::listen(listener.get(), listen_backlog) != 0 ||
      ::rename(fresh.c_str(), socket_path_.c_str()) != 0) {
    fail(socket_path_);
  }
  return HubSeat(std::move(lock), std::move(listener), lock_path_, socket_path_);
}

bool is_same_user(int socket_fd) noexcept {
  ucred peer{};
  socklen_t size = sizeof peer;
  return ::getsockopt(socket_fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         (peer.uid == ::geteuid() || peer.uid == 0);
}

}  // namespace roio::local
