#ifndef ROIO_LOCAL_PRESENCE_HPP
#define ROIO_LOCAL_PRESENCE_HPP

#include <cstdint>
#include <string>

#include "parts/fork.hpp"

namespace roio::local {

/// Whether the file that is open is the one at `path`.
bool is_file_at(int fd, const std::string& path) noexcept;

/// That a client is alive: a lock on the bus's lock file, at a place of its own, which the kernel
/// gives back when its process ends. So a hub knows who is still to come over from the hub before,
/// though it be stopped for an hour, and who never will.
class Presence {
 public:
  Presence() = default;
  /// @param path of the lock file. @param client its random number.
  /// No file, or somebody has the lock: not shown.
  Presence(const std::string& path, std::uint64_t client);

  [[nodiscard]] bool shown() const { return static_cast<bool>(file_); }
  /// The lock file, open to read and write; -1 when not shown.
  [[nodiscard]] int fd() const { return file_.get(); }
  /// Whether that is what the file at `path` is.
  [[nodiscard]] bool is_at(const std::string& path) const { return is_file_at(fd(), path); }
  /// From now on the client is not there.
  void end();

  Presence(Presence&& other) noexcept = default;
  Presence& operator=(Presence&& other) noexcept;
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;
  ~Presence() { end(); }

 private:
  ParentsFd file_;
};

/// Whether the client shows its presence in the file.
bool is_present(int lock_fd, std::uint64_t client);

}  // namespace roio::local

#endif
