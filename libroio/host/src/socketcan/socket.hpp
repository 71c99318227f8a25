#ifndef ROIO_SOCKETCAN_SOCKET_HPP
#define ROIO_SOCKETCAN_SOCKET_HPP

#include <cstdint>
#include <optional>
#include <roio/filter_socketcan.hpp>
#include <roio/parts/fd.hpp>
#include <span>
#include <string>

#include "parts/fork.hpp"

/// The system calls that set up SocketCAN, one idea each. Errors are thrown as std::system_error
/// about the interface, unless a function says otherwise.
namespace roio::socketcan {

/// A network interface at one moment.
struct InterfaceLook {
  int index = 0;         ///< 0: there is none of that name.
  bool is_can = false;   ///< ARPHRD_CAN.
  bool up = false;       ///< Administratively.
  bool carrier = false;  ///< Off while the controller is bus-off.
};

/// A non-blocking raw socket with time stamps, drop counts and error reports, large in receiving
/// and small in sending; bound to nothing yet.
/// @throws Errc::no_can_support
ParentsFd make_socket(const std::string& interface_name);

/// Becomes readable when any interface comes, goes or changes. @see discard_news
UniqueFd make_news_socket(const std::string& interface_name);
void discard_news(int news_socket) noexcept;

InterfaceLook look_at(int socket, const std::string& interface_name) noexcept;

/// The filters of a socket, bound or not; none receives nothing.
/// @return 0 or an errno.
int apply_filters(int socket, std::span<const SocketCanFilter> filters) noexcept;
/// Stops error reports too.
void mute(int socket) noexcept;

/// @return 0 or an errno.
int bind_to(int socket, int interface_index) noexcept;
/// What the kernel has the socket bound to; 0 once the interface has been deleted.
int bound_interface(int socket) noexcept;

/// The socket's pending error, taken from it; 0 when there is none.
int take_error(int socket) noexcept;

/// Frames, error reports among them, that the kernel had no room for in this socket, modulo 2^32;
/// nothing before Linux 4.12.
std::optional<std::uint32_t> count_drops(int socket) noexcept;

}  // namespace roio::socketcan

#endif
