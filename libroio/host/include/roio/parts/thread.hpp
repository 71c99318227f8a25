#ifndef ROIO_PARTS_THREAD_HPP
#define ROIO_PARTS_THREAD_HPP

#include <pthread.h>

#include <csignal>
#include <mutex>
#include <thread>
#include <utility>

namespace roio {

/// While it lives, the calling thread and those it starts take no signals. Ends in the thread that
/// it began in. A library's threads must not get the program's signals: a handler would run in a
/// thread that the program knows nothing of, and the program's own waits would go on.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

/// Starts a thread that no signal is delivered to: those are the program's own.
/// @param function what it runs. It must not throw: that would end the program.
/// @return to be joined before anything that it uses ends.
/// @throws std::system_error: the system has no more threads.
template <typename Function>
std::thread start_thread(Function&& function) {
  const SignalsBlocked blocked;
  return std::thread(std::forward<Function>(function));
}

/// Such a thread, which several threads may wait for at once: those that call close().
class SharedThread {
 public:
  SharedThread() = default;
  SharedThread(const SharedThread&) = delete;
  SharedThread& operator=(const SharedThread&) = delete;
  ~SharedThread() { join(); }

  /// Once. As start_thread().
  template <typename Function>
  void start(Function&& function) {
    thread_ = start_thread(std::forward<Function>(function));
  }
  /// Returns when it has ended, or was never started. Not from itself.
  void join() noexcept {
    const std::lock_guard lock(mutex_);
    if (thread_.joinable()) {
      thread_.join();
    }
  }

 private:
  std::mutex mutex_;
  std::thread thread_;
};

}  // namespace roio

#endif
