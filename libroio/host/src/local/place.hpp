#ifndef ROIO_LOCAL_PLACE_HPP
#define ROIO_LOCAL_PLACE_HPP

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "parts/fork.hpp"

namespace roio::local {

/// The right to be a bus's hub: held by one process at a time, given back by the kernel when it
/// dies.
class HubSeat {
 public:
  HubSeat(ParentsFd lock, std::string lock_path, std::string socket_path);
  HubSeat(HubSeat&&) noexcept = default;
  HubSeat& operator=(HubSeat&&) = delete;
  HubSeat(const HubSeat&) = delete;
  HubSeat& operator=(const HubSeat&) = delete;
  ~HubSeat();  ///< leave(), with the memory left for the next.

  /// Lets clients come. @throws std::system_error: no socket can be made there.
  void open();
  [[nodiscard]] int listener() const noexcept { return listener_.get(); }
  /// The lock file, which has the bus's memory.
  [[nodiscard]] int lock_fd() const noexcept { return lock_.get(); }
  /// Whether who looks for the bus finds this seat: its files have not been removed, and no others
  /// put there.
  [[nodiscard]] bool is_in_place() const;
  /// Removes the socket, and the memory too when nobody is left who needs it; then another may take
  /// the seat.
  void leave(bool remove_memory) noexcept;

 private:
  ParentsFd lock_;
  [[nodiscard]] bool has_lock_in_place() const;

  ParentsFd listener_;
  std::string lock_path_;
  std::string socket_path_;
  ino_t socket_file_ = 0;
};

/// The folders in which this user's local buses may be; the first is where new ones are made. They
/// need not be there yet.
///
///   $ROIO_RUNTIME_DIR    alone, where it is set
///   /run/user/UID/roio   where logind has made /run/user/UID, whatever XDG_RUNTIME_DIR says: a
///                        service and a shell of one user may differ in that, and would meet on two
///                        buses without a word
///   /tmp/roio-UID        also looked in behind that one, for a bus that began before a login
///
/// @throws Errc::relative_path: ROIO_RUNTIME_DIR is one.
std::vector<std::string> folders();
/// The same from what it depends on. @param chosen null: not set.
std::vector<std::string> folders(const char* chosen, const std::string& run,
                                 const std::string& tmp);

/// Where a local bus is in the file system: NAME.sock and NAME.lock in one of folders().
class Place {
 public:
  /// Makes the first folder. @throws Errc::not_permitted: it is another's or open to others;
  /// std::system_error: it cannot be made, or the path is too long for a socket.
  explicit Place(const std::string& bus_name);

  struct Hub {
    ParentsFd socket;
    std::string lock_path;
    pid_t process;
  };
  /// A connection to the hub; none when nobody is there (or it is too busy to take one just now).
  /// @throws Errc::not_permitted: what listens there is another user's.
  [[nodiscard]] std::optional<Hub> find() const;

  /// The lock file of the bus in each of the folders, there or not.
  [[nodiscard]] std::vector<std::string> lock_paths() const;

  /// Gets the right to be the hub; none when another process has it.
  [[nodiscard]] std::optional<HubSeat> claim() const;

 private:
  [[nodiscard]] std::optional<Hub> find_in(const std::string& folder) const;
  [[nodiscard]] std::string folder_to_claim(const std::vector<std::string>& all) const;
  [[nodiscard]] bool is_carried_in(const std::string& folder) const;

  std::string bus_name_;
};

/// Whether the other end of a connected Unix socket is this user (or root).
bool is_same_user(int socket_fd) noexcept;

/// "process 4711 (roio-cli)", for people.
std::string describe_process(pid_t process);
/// Whether it has been stopped, by Ctrl-Z or a debugger.
bool is_stopped(pid_t process);

}  // namespace roio::local

#endif
