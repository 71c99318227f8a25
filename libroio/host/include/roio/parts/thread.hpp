#ifndef ROIO_PARTS_THREAD_HPP
#define ROIO_PARTS_THREAD_HPP

#include <pthread.h>

#include <csignal>
#include <thread>
#include <utility>

namespace roio {

/// While it lives, the calling thread and those it starts take no signals.
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
template <typename Function>
std::thread start_thread(Function&& function) {
  const SignalsBlocked blocked;
  return std::thread(std::forward<Function>(function));
}

}  // namespace roio

#endif
