#include "pty_bridge.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace roio::test {
namespace {

Time steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

}  // namespace

PtyBridge::PtyBridge(bool answers) {
  bridge_.is_deaf = !answers;
  plug();
  thread_ = std::thread([this] { run(); });
}

PtyBridge::~PtyBridge() {
  stop_ = true;
  thread_.join();
}

void PtyBridge::plug() {
  const std::lock_guard lock(mutex_);
  master_.reset(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 64> name{};
  if (!master_ || ::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0 ||
      ::ptsname_r(master_.get(), name.data(), name.size()) != 0) {
    throw std::runtime_error("no pseudo terminal");
  }
  path_ = name.data();
  slave_.reset(::open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  ::tcgetattr(slave_.get(), &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(slave_.get(), TCSANOW, &settings);
}

void PtyBridge::unplug() {
  const std::lock_guard lock(mutex_);
  master_.reset();
  slave_.reset();
}

void PtyBridge::hear(const Frame& frame) {
  with([&frame](ScriptedBridge& bridge) { bridge.hear(frame, steady_now()); });
}

void PtyBridge::run() {
  while (!stop_) {
    ::poll(nullptr, 0, 1);
    const std::lock_guard lock(mutex_);
    std::array<std::uint8_t, 4096> bytes{};
    const ssize_t count = master_ ? ::read(master_.get(), bytes.data(), bytes.size()) : 0;
    for (ssize_t i = 0; i < count; ++i) {
      bridge_.take(bytes.at(static_cast<std::size_t>(i)), steady_now());
    }
    bridge_.on_time(steady_now());
    Bytes out;
    for (const ScriptedBridge::Sent& sent : bridge_.out) {
      out.push_back(sent.byte);
    }
    bridge_.out.clear();
    if (master_ && !out.empty()) {
      static_cast<void>(!::write(master_.get(), out.data(), out.size()));
    }
  }
}

}  // namespace roio::test
