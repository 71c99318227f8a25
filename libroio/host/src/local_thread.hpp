#ifndef ROIO_LOCAL_THREAD_HPP
#define ROIO_LOCAL_THREAD_HPP

#include <pthread.h>

#include <csignal>
#include <thread>
#include <utility>

namespace roio::local {

/// Starts a thread that no signal is delivered to: those are the program's own.
template <typename Function>
std::thread start_thread(Function&& function) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  struct Restore {
    sigset_t* mask;
    ~Restore() { pthread_sigmask(SIG_SETMASK, mask, nullptr); }
  } restore{&before};
  return std::thread(std::forward<Function>(function));
}

}  // namespace roio::local

#endif
