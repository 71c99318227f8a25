#include "fake_kernel.hpp"

#include <dlfcn.h>
#include <linux/can/raw.h>
#include <linux/sock_diag.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roio {
namespace {

std::atomic<FakeKernel*> the_kernel{nullptr};

void wait_for(int fd, short events) {
  constexpr int patience_ms = 20000;
  pollfd entry{fd, events, 0};
  if (::poll(&entry, 1, patience_ms) != 1) {
    std::fputs("fake kernel: nothing happened for 20 s\n", stderr);
    std::abort();
  }
}

std::optional<FakeAnswer> take_first(std::deque<FakeAnswer>& answers) {
  if (answers.empty()) {
    return std::nullopt;
  }
  const FakeAnswer first = answers.front();
  answers.pop_front();
  return first;
}

}  // namespace

FakeKernel::FakeKernel() {
  the_kernel = this;
}

FakeKernel::~FakeKernel() {
  the_kernel = nullptr;
  for (const auto& [fd, socket] : sockets_) {
    ::close(socket.wire);
  }
}

FakeKernel* FakeKernel::current() {
  return the_kernel;
}

void FakeKernel::set_interface(const std::string& name, const FakeInterface& interface) {
  const std::lock_guard lock(mutex_);
  interfaces_[name] = interface;
  announce();
}

void FakeKernel::remove_interface(const std::string& name) {
  const std::lock_guard lock(mutex_);
  for (auto& [fd, socket] : sockets_) {
    socket.bound = socket.bound == interfaces_[name].index ? 0 : socket.bound;
  }
  interfaces_.erase(name);
  announce();
}

void FakeKernel::announce() {
  for (const auto& [fd, socket] : sockets_) {
    if (socket.news) {
      static_cast<void>(::send(socket.wire, "news", 4, MSG_DONTWAIT | MSG_NOSIGNAL));
    }
  }
}

void FakeKernel::refuse_sockets(int error) {
  const std::lock_guard lock(mutex_);
  refusal_ = error;
}

void FakeKernel::answer_sends_with(const std::vector<FakeAnswer>& answers) {
  const std::lock_guard lock(mutex_);
  sends_.assign(answers.begin(), answers.end());
}

void FakeKernel::answer_receives_with(const std::vector<FakeAnswer>& answers) {
  const std::lock_guard lock(mutex_);
  receives_.assign(answers.begin(), answers.end());
}

void FakeKernel::set_drops(std::uint32_t drops) {
  const std::lock_guard lock(mutex_);
  drops_ = drops;
}

std::uint32_t FakeKernel::drops() {
  const std::lock_guard lock(mutex_);
  return drops_;
}

int FakeKernel::last_wire() {
  const std::lock_guard lock(mutex_);
  return last_;
}

void FakeKernel::put_bytes(const void* frame, std::size_t size) {
  const int wire = last_wire();
  while (::send(wire, frame, size, MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
    wait_for(wire, POLLOUT);
  }
}

void FakeKernel::put(const canfd_frame& frame) {
  bool taken = false;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [fd, socket] : sockets_) {
      taken = taken || (socket.wire == last_ && socket.takes_fd);
    }
  }
  if (taken) {
    put_bytes(&frame, sizeof frame);
  }
}

void FakeKernel::take_fd_frames(int fd) {
  const std::lock_guard lock(mutex_);
  sockets_[fd].takes_fd = true;
}

can_frame FakeKernel::get() {
  const int wire = last_wire();
  can_frame frame{};
  while (::recv(wire, &frame, sizeof frame, MSG_DONTWAIT) < 0) {
    wait_for(wire, POLLIN);
  }
  return frame;
}

int FakeKernel::open_socket(bool news) {
  const std::lock_guard lock(mutex_);
  if (!news && refusal_ != 0) {
    errno = refusal_;
    return -1;
  }
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return -1;
  }
  sockets_[ends[0]] = Socket{ends[1], news};
  if (!news) {
    last_ = ends[1];
  }
  return ends[0];
}

bool FakeKernel::owns(int fd) {
  const std::lock_guard lock(mutex_);
  return sockets_.count(fd) != 0;
}

void FakeKernel::bind(int fd, int index) {
  const std::lock_guard lock(mutex_);
  sockets_[fd].bound = index;
}

int FakeKernel::bound(int fd) {
  const std::lock_guard lock(mutex_);
  return sockets_[fd].bound;
}

std::optional<FakeInterface> FakeKernel::find(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = interfaces_.find(name);
  return found == interfaces_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<FakeAnswer> FakeKernel::next_send(int fd) {
  const std::lock_guard lock(mutex_);
  if (!sends_.empty()) {
    return take_first(sends_);
  }
  for (const auto& [name, interface] : interfaces_) {
    if (interface.index == sockets_[fd].bound) {
      return interface.up ? std::nullopt : std::optional(FakeAnswer{ENETDOWN});
    }
  }
  return FakeAnswer{ENXIO};
}

std::optional<FakeAnswer> FakeKernel::next_receive() {
  const std::lock_guard lock(mutex_);
  return take_first(receives_);
}

}  // namespace roio

// --- the system calls
// -----------------------------------------------------------------------------

namespace {

using roio::FakeKernel;

/// The C library's own, or a sanitizer's.
template <typename Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

bool is_ours(int fd) {
  return FakeKernel::current() != nullptr && FakeKernel::current()->owns(fd);
}

/// @return how many may go, or -1 with errno set.
int bounded(const std::optional<roio::FakeAnswer>& answer, unsigned count) {
  if (!answer) {
    return static_cast<int>(count);
  }
  errno = answer->error;
  return answer->error != 0 ? -1 : static_cast<int>(std::min(count, answer->at_most));
}

}  // namespace

extern "C" {

int socket(int domain, int type, int protocol) noexcept {
  static const auto next = real<int (*)(int, int, int)>("socket");
  if (FakeKernel::current() != nullptr && (domain == PF_CAN || domain == AF_NETLINK)) {
    return FakeKernel::current()->open_socket(domain == AF_NETLINK);
  }
  return next(domain, type, protocol);
}

int bind(int fd, const sockaddr* address, socklen_t length) noexcept {
  static const auto next = real<int (*)(int, const sockaddr*, socklen_t)>("bind");
  if (!is_ours(fd)) {
    return next(fd, address, length);
  }
  if (address->sa_family == AF_CAN) {
    FakeKernel::current()->bind(fd, reinterpret_cast<const sockaddr_can*>(address)->can_ifindex);
  }
  return 0;
}

int getsockname(int fd, sockaddr* address, socklen_t* length) noexcept {
  static const auto next = real<int (*)(int, sockaddr*, socklen_t*)>("getsockname");
  if (!is_ours(fd)) {
    return next(fd, address, length);
  }
  reinterpret_cast<sockaddr_can*>(address)->can_ifindex = FakeKernel::current()->bound(fd);
  return 0;
}

int setsockopt(int fd, int level, int option, const void* value, socklen_t length) noexcept {
  static const auto next = real<int (*)(int, int, int, const void*, socklen_t)>("setsockopt");
  if (is_ours(fd) && level == SOL_CAN_RAW && option == CAN_RAW_FD_FRAMES) {
    FakeKernel::current()->take_fd_frames(fd);
  }
  // A small send buffer would make a Unix socket full at moments that no test has chosen.
  if (is_ours(fd) && (level == SOL_CAN_RAW || option == SO_SNDBUF)) {
    return 0;
  }
  return next(fd, level, option, value, length);
}

int getsockopt(int fd, int level, int option, void* value, socklen_t* length) noexcept {
  static const auto next = real<int (*)(int, int, int, void*, socklen_t*)>("getsockopt");
  const int result = next(fd, level, option, value, length);
  if (is_ours(fd) && level == SOL_SOCKET && option == SO_MEMINFO) {
    static_cast<std::uint32_t*>(value)[SK_MEMINFO_DROPS] = FakeKernel::current()->drops();
  }
  return result;
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  static const auto next = real<int (*)(int, unsigned long, ...)>("ioctl");
  if (!is_ours(fd)) {
    return next(fd, request, argument);
  }
  auto* answer = static_cast<ifreq*>(argument);
  const auto found = FakeKernel::current()->find(answer->ifr_name);
  if (!found) {
    errno = ENODEV;
    return -1;
  }
  switch (request) {
    case SIOCGIFINDEX:
      answer->ifr_ifindex = found->index;
      break;
    case SIOCGIFHWADDR:
      answer->ifr_hwaddr.sa_family = found->is_can ? ARPHRD_CAN : ARPHRD_LOOPBACK;
      break;
    default:
      answer->ifr_flags =
          static_cast<short>((found->up ? IFF_UP : 0) | (found->carrier ? IFF_RUNNING : 0));
      break;
  }
  return 0;
}

int sendmmsg(int fd, mmsghdr* messages, unsigned count, int flags) {
  static const auto next = real<int (*)(int, mmsghdr*, unsigned, int)>("sendmmsg");
  if (!is_ours(fd)) {
    return next(fd, messages, count, flags);
  }
  const int allowed = bounded(FakeKernel::current()->next_send(fd), count);
  return allowed < 0 ? -1 : next(fd, messages, static_cast<unsigned>(allowed), flags);
}

int recvmmsg(int fd, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  static const auto next = real<int (*)(int, mmsghdr*, unsigned, int, timespec*)>("recvmmsg");
  if (!is_ours(fd)) {
    return next(fd, messages, count, flags, timeout);
  }
  const int allowed = bounded(FakeKernel::current()->next_receive(), count);
  return allowed < 0 ? -1 : next(fd, messages, static_cast<unsigned>(allowed), flags, timeout);
}

}  // extern "C"
