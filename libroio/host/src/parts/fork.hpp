#ifndef ROIO_PARTS_FORK_HPP
#define ROIO_PARTS_FORK_HPP

#include <memory>
#include <roio/bus.hpp>
#include <roio/parts/fd.hpp>

/// fork() copies a program's buses, but not the threads that serve them, and what both then did
/// with the same sockets and locks would end the parent's bus. So a bus stays the parent's: in the
/// child it is as if closed, and the child holds nothing that belongs to it.
namespace roio {

/// While there is one, fork() waits.
class NoFork {
 public:
  NoFork();
  NoFork(const NoFork&) = delete;
  NoFork& operator=(const NoFork&) = delete;
  ~NoFork();
};

/// Owns a descriptor that children which fork() without exec() makes do not have: there it is
/// closed at once. The parent's locks are its own then, and end with it.
class ParentsFd {
 public:
  ParentsFd() = default;
  /// What `open` returns, a UniqueFd. Nobody in this process forks meanwhile, so that no child gets
  /// what is not known yet; it should not take long.
  template <typename Open>
  static ParentsFd of(Open open) {
    const NoFork no_fork;
    return ParentsFd(no_fork, open());
  }
  ParentsFd(ParentsFd&& other) noexcept = default;
  ParentsFd& operator=(ParentsFd&& other) noexcept;
  ParentsFd(const ParentsFd&) = delete;
  ParentsFd& operator=(const ParentsFd&) = delete;
  ~ParentsFd() { reset(); }

  [[nodiscard]] int get() const noexcept { return fd_.get(); }
  explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
  void reset() noexcept;

 private:
  ParentsFd(const NoFork&, UniqueFd fd);

  UniqueFd fd_;
};

/// A bus that is closed in children of this process, and forgotten there when it ends.
std::unique_ptr<Bus> parents_bus(std::unique_ptr<Bus> bus);
/// What parents_bus() was given, else the bus; null in a child.
Bus* bus_itself(Bus& bus) noexcept;

}  // namespace roio

#endif
