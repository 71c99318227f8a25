/// A scripted bridge behind a pseudo terminal, in real time; or a terminal that nobody answers at.
#ifndef ROIO_TESTS_SERIAL_PTY_BRIDGE_HPP
#define ROIO_TESTS_SERIAL_PTY_BRIDGE_HPP

#include <atomic>
#include <functional>
#include <mutex>
#include <roio/parts/fd.hpp>
#include <string>
#include <thread>

#include "scripted_bridge.hpp"

namespace roio::test {

class PtyBridge {
 public:
  explicit PtyBridge(bool answers = true);
  ~PtyBridge();
  PtyBridge(const PtyBridge&) = delete;
  PtyBridge& operator=(const PtyBridge&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

  /// Looks at the bridge, or changes it, between two of its steps.
  template <typename Look>
  auto with(const Look& look) {
    const std::lock_guard lock(mutex_);
    return look(bridge_);
  }
  void hear(const Frame& frame);
  /// The cable is pulled: the terminal is gone, the bridge is not.
  void unplug();
  /// And put in again: there is another terminal.
  void plug();

 private:
  void run();

  ScriptedBridge bridge_;
  std::mutex mutex_;
  UniqueFd master_;
  UniqueFd slave_;  // keeps the terminal raw
  std::string path_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace roio::test

#endif
