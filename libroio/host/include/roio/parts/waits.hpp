#ifndef ROIO_PARTS_WAITS_HPP
#define ROIO_PARTS_WAITS_HPP

#include <atomic>
#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/parts/fd.hpp>

namespace roio {

/// Waits that another thread or a signal handler can end.
class ROIO_EXPORT Waits {
 public:
  void cancel() noexcept {
    is_cancelled_.store(true, std::memory_order_release);
    cancelled_.set();
  }
  void resume() noexcept {
    is_cancelled_.store(false, std::memory_order_release);
    cancelled_.clear();
  }
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

  /// One more descriptor to wait for, with poll()'s events.
  struct For {
    int fd = -1;  ///< -1: none.
    short events = 0;
  };
  struct Woken {
    Result result;  ///< ok: one of the two may be ready.
    bool second_ready;
  };
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
