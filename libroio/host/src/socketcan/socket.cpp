#include "socketcan/socket.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <linux/sock_diag.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <roio/error.hpp>
#include <system_error>

namespace roio::socketcan {
namespace {

static_assert(extended_flag == CAN_EFF_FLAG && remote_flag == CAN_RTR_FLAG &&
              error_flag == CAN_ERR_FLAG && inverted == CAN_INV_FILTER);
static_assert(sizeof(SocketCanFilter) == sizeof(can_filter) &&
                  offsetof(SocketCanFilter, can_id) == offsetof(can_filter, can_id) &&
                  offsetof(SocketCanFilter, can_mask) == offsetof(can_filter, can_mask),
              "filters go to the kernel as they are");

// The kernel doubles this and counts about 768 bytes for a waiting frame, so it holds some 174,000:
// 22 seconds of a saturated 1 Mbit/s bus. Memory is taken only for frames that do wait.
constexpr int receive_buffer_bytes = 64 << 20;

// Less than the shortest common transmit queue (10 frames): a full one is then EAGAIN with a
// POLLOUT to wait for, not ENOBUFS. The kernel raises it to its own minimum, about 6 frames.
constexpr int send_buffer_bytes = 1;

[[noreturn]] void throw_errno(int error, const std::string& interface_name) {
  throw std::system_error(error, std::generic_category(), interface_name);
}

int set_option(int socket, int level, int option, int value) noexcept {
  return ::setsockopt(socket, level, option, &value, sizeof value) == 0 ? 0 : errno;
}

void require(int error, const std::string& interface_name) {
  if (error != 0) {
    throw_errno(error, interface_name);
  }
}

void set_up(int socket, const std::string& interface_name) {
  require(set_option(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1), interface_name);
  require(set_option(socket, SOL_SOCKET, SO_RXQ_OVFL, 1), interface_name);
  require(set_option(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, CAN_ERR_MASK), interface_name);
  // Else they would pass unseen. What is sent stays classic, and the same filters apply.
  require(set_option(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1), interface_name);
  require(set_option(socket, SOL_SOCKET, SO_SNDBUF, send_buffer_bytes), interface_name);
  // Beyond net.core.rmem_max only with CAP_NET_ADMIN; others get as much as is allowed.
  if (set_option(socket, SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer_bytes) != 0) {
    require(set_option(socket, SOL_SOCKET, SO_RCVBUF, receive_buffer_bytes), interface_name);
  }
}

bool ask(int socket, unsigned long request, const std::string& name, ifreq& answer) noexcept {
  answer = ifreq{};
  if (name.empty() || name.size() >= sizeof answer.ifr_name) {
    return false;
  }
  std::memcpy(answer.ifr_name, name.data(), name.size());
  return ::ioctl(socket, request, &answer) == 0;
}

}  // namespace

ParentsFd make_socket(const std::string& interface_name) {
  auto socket = ParentsFd::of(
      [] { return UniqueFd(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)); });
  if (!socket) {
    if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT) {
      throw std::system_error(Errc::no_can_support, interface_name);
    }
    throw_errno(errno, interface_name);
  }
  set_up(socket.get(), interface_name);
  return socket;
}

UniqueFd make_news_socket(const std::string& interface_name) {
  UniqueFd socket(::socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = RTMGRP_LINK;
  if (!socket ||
      ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw_errno(errno, interface_name);
  }
  return socket;
}

void discard_news(int news_socket) noexcept {
  // What has changed is looked up, so only the fact matters; a lost message (ENOBUFS) is news too.
  char start = 0;
  while (::recv(news_socket, &start, sizeof start, 0) >= 0 || errno == ENOBUFS || errno == EINTR) {
  }
}

InterfaceLook look_at(int socket, const std::string& interface_name) noexcept {
  InterfaceLook look;
  ifreq answer;
  if (!ask(socket, SIOCGIFINDEX, interface_name, answer)) {
    return look;
  }
  look.index = answer.ifr_ifindex;
  look.is_can = ask(socket, SIOCGIFHWADDR, interface_name, answer) &&
                answer.ifr_hwaddr.sa_family == ARPHRD_CAN;
  if (ask(socket, SIOCGIFFLAGS, interface_name, answer)) {
    const auto flags = static_cast<unsigned short>(answer.ifr_flags);
    look.up = (flags & IFF_UP) != 0;
    look.carrier = (flags & IFF_RUNNING) != 0;
  }
  return look;
}

int apply_filters(int socket, std::span<const SocketCanFilter> filters) noexcept {
  const auto length = static_cast<socklen_t>(filters.size_bytes());
  return ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), length) == 0 ? 0 : errno;
}

void mute(int socket) noexcept {
  static_cast<void>(apply_filters(socket, {}));
  static_cast<void>(set_option(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, 0));
}

int bind_to(int socket, int interface_index) noexcept {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = interface_index;
  return ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0
                                                                                          : errno;
}

int bound_interface(int socket) noexcept {
  sockaddr_can address{};
  socklen_t length = sizeof address;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    return 0;
  }
  return address.can_ifindex;
}

int take_error(int socket) noexcept {
  int error = 0;
  socklen_t length = sizeof error;
  static_cast<void>(::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &length));
  return error;
}

std::optional<std::uint32_t> count_drops(int socket) noexcept {
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t length = sizeof memory;
  if (::getsockopt(socket, SOL_SOCKET, SO_MEMINFO, memory.data(), &length) != 0 ||
      length <= SK_MEMINFO_DROPS * sizeof memory[0]) {
    return std::nullopt;
  }
  return memory[SK_MEMINFO_DROPS];
}

}  // namespace roio::socketcan
