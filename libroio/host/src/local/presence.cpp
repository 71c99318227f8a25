#include "local/presence.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <utility>

namespace roio::local {
namespace {

// One byte, far behind what is in the file. An open file description's lock: a process may have
// several buses, and none of them ends with the first descriptor that is closed.
struct flock place_of(std::uint64_t client) {
  constexpr std::uint64_t longest = (UINT64_C(1) << 62) - 1;
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(client & longest);
  lock.l_len = 1;
  return lock;
}

}  // namespace

Presence::Presence(const std::string& path, std::uint64_t client) {
  auto file = ParentsFd::of([&] { return UniqueFd(::open(path.c_str(), O_RDWR | O_CLOEXEC)); });
  struct flock lock = place_of(client);
  if (file && ::fcntl(file.get(), F_OFD_SETLK, &lock) == 0) {
    file_ = std::move(file);
  }
}

Presence& Presence::operator=(Presence&& other) noexcept {
  end();
  file_ = std::move(other.file_);
  return *this;
}

void Presence::end() {
  if (file_) {
    // The memory that is mapped from the file would keep the lock otherwise.
    struct flock all {};
    all.l_type = F_UNLCK;
    all.l_whence = SEEK_SET;
    ::fcntl(file_.get(), F_OFD_SETLK, &all);
    file_.reset();
  }
}

bool is_file_at(int fd, const std::string& path) noexcept {
  struct stat open {};
  struct stat there {};
  return ::fstat(fd, &open) == 0 && ::stat(path.c_str(), &there) == 0 &&
         open.st_ino == there.st_ino && open.st_dev == there.st_dev;
}

bool is_present(int lock_fd, std::uint64_t client) {
  struct flock lock = place_of(client);
  // A lock that cannot be asked for is taken for one that is held: nobody is forgotten by mistake.
  return ::fcntl(lock_fd, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
}

}  // namespace roio::local
