#ifndef ROIO_PARTS_FD_HPP
#define ROIO_PARTS_FD_HPP

#include <cstdint>
#include <utility>

#include <roio/export.hpp>

namespace roio {

/// Owns a file descriptor; -1 is none.
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
  void reset(int fd = -1) noexcept;

 private:
  int fd_ = -1;
};

/// A flag that poll() can wait for: readable while it is set.
class ROIO_EXPORT EventFlag {
 public:
  EventFlag();  ///< @throws std::system_error when there are no descriptors left.

  /// Safe in a signal handler. Setting what is set changes nothing.
  void set() noexcept;
  void clear() noexcept;
  [[nodiscard]] bool is_set() const noexcept;
  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

 private:
  UniqueFd fd_;
};

}  // namespace roio

#endif
