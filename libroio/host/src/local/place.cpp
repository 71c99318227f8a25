#include "local/place.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <utility>

#include "local/memory.hpp"
#include "local/presence.hpp"

namespace roio::local {
namespace {

constexpr int listen_backlog = 128;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

bool is_private_folder(const std::string& path) {
  struct stat status {};
  constexpr mode_t others = S_IRWXG | S_IRWXO;
  return ::lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == ::geteuid() && (status.st_mode & others) == 0;
}

void make_private_folder(const std::string& path) {
  if (::mkdir(path.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    fail(path);
  }
  if (!is_private_folder(path)) {
    throw std::system_error(Errc::not_permitted,
                            path +
                                ": expected a folder of this user's with mode 0700; "
                                "ROIO_RUNTIME_DIR can name another");
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

ParentsFd make_socket() {
  auto fd = ParentsFd::of(
      [] { return UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)); });
  if (!fd) {
    fail("socket");
  }
  return fd;
}

const sockaddr* generic(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

ParentsFd open_lock(const std::string& path, int flags) {
  return ParentsFd::of(
      [&] { return UniqueFd(::open(path.c_str(), flags | O_CLOEXEC, S_IRUSR | S_IWUSR)); });
}

std::string socket_path(const std::string& folder, const std::string& bus_name) {
  return folder + "/" + bus_name + ".sock";
}

std::string lock_path(const std::string& folder, const std::string& bus_name) {
  return folder + "/" + bus_name + ".lock";
}

ucred peer_of(int socket_fd) noexcept {
  ucred peer{-1, static_cast<uid_t>(-1), static_cast<gid_t>(-1)};
  socklen_t size = sizeof peer;
  static_cast<void>(::getsockopt(socket_fd, SOL_SOCKET, SO_PEERCRED, &peer, &size));
  return peer;
}

}  // namespace

std::vector<std::string> folders(const char* chosen, const std::string& run,
                                 const std::string& tmp) {
  if (chosen != nullptr && *chosen != '\0') {
    // Programs in different folders would be on different buses of one name, and none would say so.
    if (*chosen != '/') {
      throw std::system_error(Errc::relative_path, "ROIO_RUNTIME_DIR " + quote(chosen));
    }
    return {chosen};
  }
  const std::string user = std::to_string(::geteuid());
  std::vector<std::string> all;
  if (const std::string of_login = run + "/" + user; is_private_folder(of_login)) {
    all.push_back(of_login + "/roio");
  }
  all.push_back(tmp + "/roio-" + user);
  return all;
}

std::vector<std::string> folders() {
  // A program that changes its environment from another thread is on its own.
  return folders(std::getenv("ROIO_RUNTIME_DIR"), "/run/user", "/tmp");
}

HubSeat::HubSeat(ParentsFd lock, std::string lock_path, std::string socket_path)
    : lock_(std::move(lock)),
      lock_path_(std::move(lock_path)),
      socket_path_(std::move(socket_path)) {}

HubSeat::~HubSeat() {
  leave(false);
}

void HubSeat::open() {
  // Bound beside its place and moved there: who finds the socket finds it listening.
  listener_ = make_socket();
  const std::string fresh = socket_path_ + ".new";
  const sockaddr_un address = address_of(fresh);
  ::unlink(fresh.c_str());
  if (::bind(listener_.get(), generic(address), sizeof address) != 0 ||
      ::chmod(fresh.c_str(), S_IRUSR | S_IWUSR) != 0 ||
      ::listen(listener_.get(), listen_backlog) != 0 ||
      ::rename(fresh.c_str(), socket_path_.c_str()) != 0) {
    fail(socket_path_);
  }
  struct stat there {};
  socket_file_ = ::lstat(socket_path_.c_str(), &there) == 0 ? there.st_ino : 0;
}

bool HubSeat::is_in_place() const {
  struct stat there {};
  return has_lock_in_place() && ::lstat(socket_path_.c_str(), &there) == 0 &&
         there.st_ino == socket_file_;
}

bool HubSeat::has_lock_in_place() const {
  return is_file_at(lock_.get(), lock_path_);
}

void HubSeat::leave(bool remove_memory) noexcept {
  if (!lock_) {
    return;
  }
  // Were the folder emptied meanwhile, what is there now would be another hub's.
  if (has_lock_in_place()) {
    ::unlink(socket_path_.c_str());
    if (remove_memory) {
      ::unlink(lock_path_.c_str());  // still locked: see Place::claim()
    }
  }
  listener_.reset();
  ::flock(lock_.get(), LOCK_UN);  // the memory that is mapped from it would keep it otherwise
  lock_.reset();
}

Place::Place(const std::string& bus_name) : bus_name_(bus_name) {
  const std::string folder = folders().front();
  make_private_folder(folder);
  static_cast<void>(address_of(socket_path(folder, bus_name) + ".new"));  // too long: say so now
}

std::optional<Place::Hub> Place::find() const {
  for (const std::string& folder : folders()) {
    if (auto hub = find_in(folder)) {
      return hub;
    }
  }
  return std::nullopt;
}

std::optional<Place::Hub> Place::find_in(const std::string& folder) const {
  if (!is_private_folder(folder)) {
    return std::nullopt;
  }
  ParentsFd socket = make_socket();
  const sockaddr_un address = address_of(socket_path(folder, bus_name_));
  if (::connect(socket.get(), generic(address), sizeof address) != 0) {
    if (errno == ENOENT || errno == ECONNREFUSED || errno == EAGAIN || errno == EINTR) {
      return std::nullopt;
    }
    fail("local:" + bus_name_);
  }
  if (!is_same_user(socket.get())) {
    throw std::system_error(Errc::not_permitted, "local:" + bus_name_);
  }
  const pid_t process = peer_of(socket.get()).pid;
  return Hub{std::move(socket), lock_path(folder, bus_name_), process};
}

bool Place::is_carried_in(const std::string& folder) const {
  const ParentsFd lock = open_lock(lock_path(folder, bus_name_), O_RDWR);
  return lock && is_private_folder(folder) && ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0;
}

std::vector<std::string> Place::lock_paths() const {
  std::vector<std::string> paths = folders();
  for (std::string& path : paths) {
    path = lock_path(path, bus_name_);
  }
  return paths;
}

/// Where the bus goes on whose hub has gone, else where a new one begins.
std::string Place::folder_to_claim(const std::vector<std::string>& all) const {
  const auto lives = std::find_if(all.begin(), all.end(), [this](const std::string& folder) {
    return is_private_folder(folder) && MemoryView(lock_path(folder, bus_name_)).has_clients();
  });
  return lives != all.end() ? *lives : all.front();
}

std::optional<HubSeat> Place::claim() const {
  const std::vector<std::string> all = folders();
  const std::string folder = folder_to_claim(all);
  for (const std::string& other : all) {
    if (other != folder && is_carried_in(other)) {
      return std::nullopt;
    }
  }
  make_private_folder(folder);  // it may have been cleaned away
  const std::string path = lock_path(folder, bus_name_);
  ParentsFd lock = open_lock(path, O_RDWR | O_CREAT);
  if (!lock) {
    fail(path);
  }
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK || errno == EINTR) {
      return std::nullopt;
    }
    fail(path);
  }
  // Who held the lock before may have removed its file since it was opened here: then this lock is
  // on a file that nobody else will find.
  if (!is_file_at(lock.get(), path)) {
    return std::nullopt;
  }
  if (is_foreign_memory(lock.get())) {
    ::unlink(path.c_str());  // who has it keeps it; the next look makes another
    return std::nullopt;
  }
  return HubSeat(std::move(lock), path, socket_path(folder, bus_name_));
}

bool is_same_user(int socket_fd) noexcept {
  const uid_t user = peer_of(socket_fd).uid;
  return user == ::geteuid() || user == 0;
}

std::string describe_process(pid_t process) {
  std::string name;
  std::getline(std::ifstream("/proc/" + std::to_string(process) + "/comm"), name);
  return "process " + std::to_string(process) + (name.empty() ? "" : " (" + name + ")");
}

bool is_stopped(pid_t process) {
  std::string stat;
  std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), stat);
  // "PID (NAME) STATE ...", and a name may have any character.
  const std::size_t end = stat.rfind(") ");
  const char state = end == std::string::npos ? '?' : stat.at(end + 2);
  return state == 'T' || state == 't';
}

}  // namespace roio::local
