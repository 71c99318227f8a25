#include "interrupt.hpp"

#include <atomic>

#include "program/process.hpp"

namespace roio::sim_tool {
namespace {

// All that a signal handler can reach.
std::atomic<int> caught{0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use it");

extern "C" void on_signal(int number) {
  caught = number;
}

}  // namespace

void catch_signals() {
  cli::catch_interrupts(on_signal);
}

int caught_signal() noexcept {
  return caught;
}

}  // namespace roio::sim_tool
