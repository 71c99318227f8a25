#include "local/counters.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

namespace roio::local {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void* map_page(const UniqueFd& fd, int protection) {
  void* page = ::mmap(nullptr, sizeof(HubCounters), protection, MAP_SHARED, fd.get(), 0);
  if (page == MAP_FAILED) {
    fail("mmap");
  }
  return page;
}

UniqueFd make_page() {
  UniqueFd fd(::memfd_create("roio-counters", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!fd) {
    fail("memfd_create");
  }
  // Sealed: were a client able to shrink it, the hub would fault on its own counters.
  if (::ftruncate(fd.get(), sizeof(HubCounters)) != 0 ||
      ::fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    fail("memfd");
  }
  return fd;
}

}  // namespace

CounterPage::CounterPage()
    : fd_(make_page()), counters_(new (map_page(fd_, PROT_READ | PROT_WRITE)) HubCounters{}) {}

CounterPage::CounterPage(UniqueFd fd) : fd_(std::move(fd)), counters_(nullptr) {
  struct stat status {};
  if (::fstat(fd_.get(), &status) != 0) {
    fail("fstat");
  }
  if (status.st_size < static_cast<off_t>(sizeof(HubCounters))) {
    errno = EPROTO;
    fail("counters");
  }
  counters_ = static_cast<HubCounters*>(map_page(fd_, PROT_READ));
}

CounterPage::CounterPage(CounterPage&& other) noexcept
    : fd_(std::move(other.fd_)), counters_(std::exchange(other.counters_, nullptr)) {}

CounterPage& CounterPage::operator=(CounterPage&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(counters_, other.counters_);
  return *this;
}

CounterPage::~CounterPage() {
  if (counters_ != nullptr) {
    ::munmap(counters_, sizeof(HubCounters));
  }
}

}  // namespace roio::local
