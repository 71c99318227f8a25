/// File descriptors that are owned, and a flag that poll() can wait for.
#ifndef ROIO_PARTS_FD_HPP
#define ROIO_PARTS_FD_HPP

#include <cstdint>
#include <roio/export.hpp>
#include <utility>

namespace roio {

/// Owns a file descriptor and closes it at its end; -1 is none. Moves as unique_ptr does. For one
/// thread at a time; no errors (what close() says is not heard).
class ROIO_EXPORT UniqueFd {
 public:
  UniqueFd() = default;
  explicit UniqueFd(int fd) noexcept : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    if (this != &other) {
      reset(std::exchange(other.fd_, -1));
    }
    return *this;
  }
  UniqueFd(const UniqueFd&) = delete;
  UniqueFd& operator=(const UniqueFd&) = delete;
  ~UniqueFd() { reset(); }

  [[nodiscard]] int get() const noexcept { return fd_; }
  explicit operator bool() const noexcept { return fd_ >= 0; }
  /// Closes what it has, and owns `fd` from now on.
  void reset(int fd = -1) noexcept;

 private:
  int fd_ = -1;
};

/// A flag that poll() can wait for: its descriptor is readable while it is set. Any number of
/// threads may use it at once; it must outlive whoever polls its descriptor.
///
/// Who sets it does so after the thing that it tells of; who waits clears it before (or under the
/// same lock as) looking whether the thing is there. The other way around a change is missed.
class ROIO_EXPORT EventFlag {
 public:
  EventFlag();  ///< @throws std::system_error when there are no descriptors left.

  /// Safe in a signal handler. Setting what is set changes nothing.
  void set() noexcept;
  /// Clearing what is clear changes nothing.
  void clear() noexcept;
  [[nodiscard]] bool is_set() const noexcept;
  /// For poll() with POLLIN only: do not read, write or close it. Stays the same.
  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

 private:
  UniqueFd fd_;
};

}  // namespace roio

#endif
