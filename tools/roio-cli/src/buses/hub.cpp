#include "buses/hub.hpp"

#include <chrono>
#include <roio/bus.hpp>

#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {

int hub(const HubOptions& options) {
  const auto bus = open_until_signal(options.bus, {.send_only = true, .carry = Carry::always});
  note(options.bus + ": carried from here; Ctrl-C ends that, and another program on it takes over");
  while (Interrupt::sleep_until(std::chrono::steady_clock::now() + std::chrono::hours(1))) {
  }
  return exit_signal + Interrupt::signal();
}

}  // namespace roio::cli
