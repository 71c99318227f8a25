#ifndef ROIO_LOCAL_PLACE_HPP
#define ROIO_LOCAL_PLACE_HPP

#include <optional>
#include <roio/parts/fd.hpp>
#include <string>

namespace roio::local {

/// The right to be a bus's hub: held by one process at a time, given back by the kernel when it
/// dies.
class HubSeat {
 public:
  HubSeat(UniqueFd lock, UniqueFd listener, std::string lock_path, std::string socket_path);
  HubSeat(HubSeat&&) noexcept = default;
  HubSeat& operator=(HubSeat&&) = delete;
  HubSeat(const HubSeat&) = delete;
  HubSeat& operator=(const HubSeat&) = delete;
  ~HubSeat();  ///< Removes socket and lock file, then gives back the lock.

  [[nodiscard]] int listener() const noexcept { return listener_.get(); }

 private:
  UniqueFd lock_;
  UniqueFd listener_;
  std::string lock_path_;
  std::string socket_path_;
};

/// The folder of this user's local buses; it need not be there yet.
std::string folder();

/// Where a local bus is in the file system: NAME.sock and NAME.lock in a folder for this user
/// alone, $ROIO_RUNTIME_DIR or else /tmp/roio-UID. Not below XDG_RUNTIME_DIR: a service and a shell
/// of one user may differ in that, and would meet on two buses without a word.
class Place {
 public:
  /// Makes the folder. @throws Errc::not_permitted: it is another's or open to others;
  /// std::system_error: it cannot be made, or the path is too long for a socket.
  explicit Place(const std::string& bus_name);

  /// A connection to the hub; none when nobody is there (or it is too busy to take one just now).
  /// @throws Errc::not_permitted: what listens there is another user's.
  [[nodiscard]] UniqueFd connect() const;

  /// Becomes the hub; none when another process is. Cleans up the socket that a killed hub left.
  [[nodiscard]] std::optional<HubSeat> claim() const;

 private:
  std::string bus_name_;
  std::string folder_;
  std::string socket_path_;
  std::string lock_path_;
};

/// Whether the other end of a connected Unix socket is this user (or root).
bool is_same_user(int socket_fd) noexcept;

}  // namespace roio::local

#endif
