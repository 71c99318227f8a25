#include "interrupt.hpp"

#include <signal.h>

#include <atomic>

namespace roio::sim_tool {
namespace {

// All that a signal handler can reach.
std::atomic<int> caught{0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use it");

extern "C" void on_signal(int number) {
  caught = number;
}

void handle(int number, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

}  // namespace

void catch_signals() {
  handle(SIGINT, on_signal, static_cast<int>(SA_RESETHAND));
  handle(SIGTERM, on_signal, static_cast<int>(SA_RESETHAND));
  handle(SIGPIPE, SIG_IGN, 0);
}

int caught_signal() noexcept {
  return caught;
}

}  // namespace roio::sim_tool
