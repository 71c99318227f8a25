#include <linux/can/netlink.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <roio/bus_list.hpp>
#include <roio/parts/fd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace roio {
namespace {

using Bytes = std::span<const std::byte>;

[[noreturn]] void fail() {
  throw std::system_error(errno, std::generic_category(), "the list of CAN interfaces");
}

/// A value at the start of some bytes, which need not be aligned; none when they are too few.
template <typename T>
std::optional<T> read(Bytes bytes) {
  if (bytes.size() < sizeof(T)) {
    return std::nullopt;
  }
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// Takes the next piece off a netlink list: a head that begins with its own length, its content,
/// and what fills it up to a multiple of 4 bytes.
template <typename Head>
std::optional<std::pair<Head, Bytes>> take(Bytes& list, std::size_t length_of(const Head&)) {
  const auto head = read<Head>(list);
  if (!head || length_of(*head) < sizeof(Head) || length_of(*head) > list.size()) {
    return std::nullopt;
  }
  const std::size_t length = length_of(*head);
  const Bytes content = list.first(length).subspan(sizeof(Head));
  list = list.subspan(std::min(list.size(), (length + 3) / 4 * 4));
  return std::pair(*head, content);
}

/// The content of the first attribute of a type; empty when there is none.
Bytes attribute(Bytes list, unsigned type) {
  while (const auto next =
             take<rtattr>(list, [](const rtattr& head) -> std::size_t { return head.rta_len; })) {
    if ((next->first.rta_type & static_cast<unsigned>(NLA_TYPE_MASK)) == type) {
      return next->second;
    }
  }
  return {};
}

std::string text(Bytes content) {
  const std::string_view all(reinterpret_cast<const char*>(content.data()), content.size());
  return std::string(all.substr(0, all.find('\0')));
}

BusState state_of(bool up, std::optional<std::uint32_t> controller) {
  if (!up) {
    return BusState::down;
  }
  switch (controller.value_or(CAN_STATE_ERROR_ACTIVE)) {
    case CAN_STATE_ERROR_ACTIVE:
      return BusState::active;
    case CAN_STATE_ERROR_WARNING:
      return BusState::warning;
    case CAN_STATE_ERROR_PASSIVE:
      return BusState::passive;
    case CAN_STATE_BUS_OFF:
      return BusState::bus_off;
    default:  // stopped, or asleep
      return BusState::down;
  }
}

/// @param content of an RTM_NEWLINK message.
std::optional<CanInterface> read_link(Bytes content) {
  const auto link = read<ifinfomsg>(content);
  if (!link || link->ifi_type != ARPHRD_CAN) {
    return std::nullopt;
  }
  const Bytes attributes = content.subspan(sizeof *link);
  const Bytes details = attribute(attributes, IFLA_LINKINFO);
  const Bytes controller = attribute(details, IFLA_INFO_DATA);
  CanInterface found;
  found.name = text(attribute(attributes, IFLA_IFNAME));
  found.kind = text(attribute(details, IFLA_INFO_KIND));
  found.state = state_of((link->ifi_flags & IFF_UP) != 0,
                         read<std::uint32_t>(attribute(controller, IFLA_CAN_STATE)));
  const auto timing = read<can_bittiming>(attribute(controller, IFLA_CAN_BITTIMING));
  if (timing && timing->bitrate != 0) {
    found.bitrate_bps = timing->bitrate;
  }
  return found;
}

/// A socket with the question put; its answer is a list of messages.
UniqueFd ask_for_links() {
  UniqueFd socket(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  const timeval longest{1, 0};  // the kernel answers at once
  struct {
    nlmsghdr head{};
    ifinfomsg link{};
  } question;
  question.head.nlmsg_len = sizeof question;
  question.head.nlmsg_type = RTM_GETLINK;
  question.head.nlmsg_flags = NLM_F_REQUEST | NLM_F_DUMP;
  if (!socket ||
      ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest) != 0 ||
      ::send(socket.get(), &question, sizeof question, 0) < 0) {
    fail();
  }
  return socket;
}

/// @return whether more of the answer is to come.
bool read_messages(Bytes answer, std::vector<CanInterface>& found) {
  while (const auto next = take<nlmsghdr>(
             answer, [](const nlmsghdr& head) -> std::size_t { return head.nlmsg_len; })) {
    const auto& [head, content] = *next;
    if (head.nlmsg_type == NLMSG_DONE) {
      return false;
    }
    if (head.nlmsg_type == NLMSG_ERROR) {
      errno = -read<nlmsgerr>(content).value_or(nlmsgerr{-EIO, {}}).error;
      fail();
    }
    if (head.nlmsg_type == RTM_NEWLINK) {
      if (auto interface = read_link(content)) {
        found.push_back(std::move(*interface));
      }
    }
  }
  return true;
}

}  // namespace

std::vector<CanInterface> can_interfaces() {
  constexpr std::size_t largest_answer = 32768;  // of one read, as libnetlink has it
  const UniqueFd socket = ask_for_links();
  std::vector<std::byte> buffer(largest_answer);
  std::vector<CanInterface> found;
  ssize_t got = 0;
  do {
    got = ::recv(socket.get(), buffer.data(), buffer.size(), 0);
    if (got < 0) {
      fail();
    }
  } while (got > 0 && read_messages(Bytes(buffer).first(static_cast<std::size_t>(got)), found));
  return found;
}

}  // namespace roio
