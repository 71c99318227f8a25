#include "local/memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "local/presence.hpp"

namespace roio::local {
namespace {

// "ROIOBUS" and the number of this layout.
constexpr std::uint64_t layout_magic = UINT64_C(0x5355424F494F5203);

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

bool has_size(int fd) {
  struct stat status {};
  return ::fstat(fd, &status) == 0 && status.st_size == static_cast<off_t>(sizeof(Memory));
}

}  // namespace

Mapping::Mapping(int fd, std::size_t offset, std::size_t size, bool writable) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t before = offset % page;
  length_ = before + size;
  start_ = ::mmap(nullptr, length_, writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, fd,
                  static_cast<off_t>(offset - before));
  if (start_ == MAP_FAILED) {
    start_ = nullptr;
    fail("the bus's memory");
  }
  // A child would keep the file, and with it the parent's locks.
  static_cast<void>(::madvise(start_, length_, MADV_DONTFORK));
  at_ = static_cast<char*>(start_) + before;
}

Mapping::Mapping(Mapping&& other) noexcept
    : start_(std::exchange(other.start_, nullptr)), length_(other.length_), at_(other.at_) {}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(start_, other.start_);
  std::swap(length_, other.length_);
  std::swap(at_, other.at_);
  return *this;
}

Mapping::~Mapping() {
  if (start_ != nullptr) {
    ::munmap(start_, length_);
  }
}

HubMemory::HubMemory(int lock_fd) {
  if (!has_size(lock_fd)) {
    // All room is taken now: where there is none, a write into the mapping would end the process.
    int error = EINTR;
    while (error == EINTR) {
      error = ::posix_fallocate(lock_fd, 0, sizeof(Memory));
    }
    if (error != 0) {
      errno = error;
      fail("the bus's memory");
    }
  }
  mapping_ = Mapping(lock_fd, 0, sizeof(Memory), true);
}

bool HubMemory::is_set_up() const {
  return (*this)->header.magic.load(std::memory_order_acquire) == layout_magic;
}

void HubMemory::set_up(std::uint32_t bitrate_bps) {
  Header& header = (*this)->header;
  header.magic.store(0, std::memory_order_relaxed);
  for (Slot& slot : (*this)->slots) {
    slot.client.store(0, std::memory_order_relaxed);
  }
  header.identity.store(random_number(), std::memory_order_relaxed);
  header.hubs.store(0, std::memory_order_relaxed);
  header.host.store(0, std::memory_order_relaxed);
  header.bitrate_bps.store(bitrate_bps, std::memory_order_relaxed);
  header.head.store(0, std::memory_order_relaxed);
  header.magic.store(layout_magic, std::memory_order_release);
}

ClientMemory::ClientMemory(int lock_fd, std::size_t slot)
    : all_(lock_fd, 0, sizeof(Memory), false),
      own_(lock_fd, offsetof(Memory, slots) + slot * sizeof(Slot), sizeof(Slot), true) {}

bool has_living_clients(const Memory& memory, int lock_fd) noexcept {
  return std::any_of(memory.slots.begin(), memory.slots.end(), [lock_fd](const Slot& slot) {
    const std::uint64_t client = slot.client.load(std::memory_order_relaxed);
    return client != 0 && is_present(lock_fd, client);
  });
}

std::uint64_t living_host(const Memory& memory, int lock_fd) noexcept {
  const std::uint64_t host = memory.header.host.load(std::memory_order_relaxed);
  return host != 0 && is_present(lock_fd, host) ? host : 0;
}

bool is_foreign_memory(int lock_fd) {
  struct stat status {};
  if (::fstat(lock_fd, &status) != 0 || status.st_size == 0) {
    return false;
  }
  if (!has_size(lock_fd)) {
    return true;
  }
  const Mapping mapping(lock_fd, 0, sizeof(Header), false);
  const std::uint64_t word = static_cast<const Header*>(mapping.at())->magic.load();
  return word != 0 && word != layout_magic;
}

MemoryView::MemoryView(const std::string& lock_path)
    : file_(::open(lock_path.c_str(), O_RDWR | O_CLOEXEC)) {
  look(file_.get());
}

MemoryView::MemoryView(int lock_fd) {
  look(lock_fd);
}

void MemoryView::look(int lock_fd) {
  if (lock_fd >= 0 && has_size(lock_fd)) {
    mapping_ = Mapping(lock_fd, 0, sizeof(Memory), false);
    lock_fd_ = lock_fd;
    is_set_up_ = (*this)->header.magic.load(std::memory_order_acquire) == layout_magic;
  }
}

}  // namespace roio::local
