#ifndef ROIO_PARTS_WAITS_HPP
#define ROIO_PARTS_WAITS_HPP

#include <atomic>
#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/parts/fd.hpp>

namespace roio {

/// Waits that another thread or a signal handler can end: what is behind Bus::cancel(), resume()
/// and close(). Any thread may call anything; it must outlive all waits, so close() and join first.
///
/// Cancelled and closed are states, not events: a wait that begins afterwards ends at once, too.
/// Closed is for ever, and goes before cancelled.
/// The default constructor throws std::system_error when there are no descriptors left.
class ROIO_EXPORT Waits {
 public:
  /// Safe in a signal handler.
  void cancel() noexcept {
    is_cancelled_.store(true, std::memory_order_release);
    cancelled_.set();
  }
  void resume() noexcept {
    is_cancelled_.store(false, std::memory_order_release);
    cancelled_.clear();
  }
  /// A second time changes nothing.
  void close() noexcept {
    is_closed_.store(true, std::memory_order_release);
    closed_.set();
  }
  [[nodiscard]] bool is_cancelled() const noexcept {
    return is_cancelled_.load(std::memory_order_acquire);
  }
  [[nodiscard]] bool is_closed() const noexcept {
    return is_closed_.load(std::memory_order_acquire);
  }

  /// What else to wait for: a descriptor, which stays its owner's, and poll()'s events.
  struct For {
    int fd = -1;  ///< -1: none.
    short events = 0;
  };
  struct Woken {
    Result result;      ///< ok: one of the two may be ready, or a signal came: look again.
    bool second_ready;  ///< The second is, whatever result says (but for closed).
  };
  /// Waits until one of them is ready, or cancel() or close() is called, or has been.
  /// @param timeout `forever` is a day here: timeout may come early, so go by a Deadline.
  /// @throws std::system_error: poll() fails, with a bad descriptor for instance.
  [[nodiscard]] Woken wait(For first, For second, Timeout timeout) const;
  [[nodiscard]] Result wait(For what, Timeout timeout) const {
    return wait(what, {}, timeout).result;
  }

 private:
  EventFlag cancelled_;
  EventFlag closed_;
  std::atomic<bool> is_cancelled_{false};
  std::atomic<bool> is_closed_{false};
};

}  // namespace roio

#endif
