#include "program/interrupt.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <ctime>
#include <optional>
#include <system_error>
#include <vector>

#include "program/exit_status.hpp"
#include "program/process.hpp"

namespace roio::cli {
namespace {

// All that a signal handler can reach.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<int> caught{0};
std::atomic<Bus*> watched{nullptr};
std::atomic<bool> opening{false};
std::array<int, 2> wake_pipe{-1, -1};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<Bus*>::is_always_lock_free &&
                  std::atomic<bool>::is_always_lock_free,
              "a signal handler may use them");

extern "C" void on_signal(int number) {
  const int saved_errno = errno;
  caught = number;
  if (opening) {
    ::_exit(exit_signal + number);
  }
  Interrupt::wake();
  if (Bus* bus = watched) {
    bus->cancel();
  }
  errno = saved_errno;
}

/// ppoll() on these and on what wakes, for at most so long (none: without limit).
void poll_for(std::span<pollfd> fds, std::optional<std::chrono::nanoseconds> timeout) {
  std::vector<pollfd> all(fds.begin(), fds.end());
  all.push_back({wake_pipe[0], POLLIN, 0});
  const auto left =
      std::max(timeout.value_or(std::chrono::nanoseconds(0)), std::chrono::nanoseconds(0));
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec until{static_cast<std::time_t>(seconds.count()),
                       static_cast<long>((left - seconds).count())};
  const int ready = ::ppoll(all.data(), all.size(), timeout ? &until : nullptr, nullptr);
  for (std::size_t i = 0; i < fds.size(); ++i) {
    fds[i].revents = ready > 0 ? all[i].revents : short{0};
  }
  if (ready > 0 && all.back().revents != 0 && caught == 0) {
    std::array<char, 64> bytes;  // of wake(); what is more is read the next time
    [[maybe_unused]] const ssize_t read = ::read(wake_pipe[0], bytes.data(), bytes.size());
  }
}

// Waits for a signal, for one of the descriptors, or for the time to pass.
enum class Woken { signal, readable, timeout };
Woken wait_for(std::span<const int> descriptors, std::optional<std::chrono::nanoseconds> timeout) {
  std::vector<pollfd> fds;
  for (const int fd : descriptors) {
    fds.push_back({fd, POLLIN, 0});
  }
  poll_for(fds, timeout);
  if (caught != 0) {
    return Woken::signal;
  }
  const bool readable =
      std::any_of(fds.begin(), fds.end(), [](const pollfd& fd) { return fd.revents != 0; });
  return readable ? Woken::readable : Woken::timeout;
}

}  // namespace

Interrupt::Interrupt() {
  if (::pipe2(wake_pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::system_error(errno, std::generic_category(), "pipe");
  }
  caught = 0;
  catch_interrupts(on_signal);
}

Interrupt::~Interrupt() {
  release_interrupts();
  for (int& fd : wake_pipe) {
    ::close(fd);
    fd = -1;
  }
}

int Interrupt::signal() noexcept {
  return caught;
}

bool Interrupt::sleep_until(std::chrono::steady_clock::time_point until) {
  for (;;) {
    const auto left = until - std::chrono::steady_clock::now();
    if (left.count() <= 0) {
      return caught == 0;
    }
    if (wait_for({}, left) == Woken::signal) {
      return false;
    }
  }
}

void Interrupt::also(int number) {
  struct sigaction now {};
  const bool is_ignored = ::sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
  if (!is_ignored) {
    catch_interrupt(number, on_signal);
  }
}

bool Interrupt::wait(std::span<pollfd> fds, std::chrono::steady_clock::time_point until) {
  poll_for(fds, until - std::chrono::steady_clock::now());
  return caught == 0;
}

void Interrupt::wake() noexcept {
  const int saved_errno = errno;
  const char byte = 0;
  // A full pipe wakes as well.
  [[maybe_unused]] const ssize_t written = ::write(wake_pipe[1], &byte, 1);
  errno = saved_errno;
}

bool Interrupt::wait_readable(int fd) {
  Woken woken = Woken::timeout;
  while (woken == Woken::timeout) {
    woken = wait_for(std::span(&fd, 1), std::nullopt);
  }
  return woken == Woken::readable;
}

bool Interrupt::wait_readable(std::span<const int> fds, std::chrono::nanoseconds timeout) {
  return wait_for(fds, timeout) == Woken::readable;
}

std::unique_ptr<Bus> open_until_signal(const std::string& url, const OpenOptions& options) {
  struct Opening {
    Opening() { opening = true; }
    Opening(const Opening&) = delete;
    Opening& operator=(const Opening&) = delete;
    ~Opening() { opening = false; }
  } const now;
  if (caught != 0) {
    ::_exit(exit_signal + caught);  // it came just before
  }
  return open(url, options);
}

CancelOnSignal::CancelOnSignal(Bus& bus) noexcept {
  watched = &bus;
  if (caught != 0) {
    bus.cancel();  // it came before there was a bus
  }
}

CancelOnSignal::~CancelOnSignal() {
  watched = nullptr;
}

}  // namespace roio::cli
