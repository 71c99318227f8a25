/// What the lab's tests share: a fresh vcan0 for each test, and other programs as peers.
/// Runs only on the lab's machine (scripts/lab), as its root.
#ifndef ROIO_TESTS_LAB_SUPPORT_HPP
#define ROIO_TESTS_LAB_SUPPORT_HPP

#include <gtest/gtest.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <roio.hpp>
#include <string>
#include <vector>

namespace roio::lab {

/// A guard against hanging, never a measure.
inline constexpr Timeout patience = std::chrono::seconds(20);
/// Long enough to say that nothing comes, on a machine of one processor.
inline constexpr Timeout a_moment = std::chrono::milliseconds(50);

/// Runs a shell command to its end; fails the test when its status is not 0.
/// @return what it wrote to its standard output.
std::string shell(const std::string& command);

/// Whether the condition becomes true within `patience`.
bool eventually(const std::function<bool()>& condition);

/// A program in the background, killed at the end of scope.
class Peer {
 public:
  explicit Peer(const std::string& command);
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer();

  /// Waits until it has ended by itself.
  /// @return its exit status, -1 when it was killed or did not end within `patience`.
  int wait();
  /// What it has written to its standard output so far.
  [[nodiscard]] std::string output() const;

 private:
  std::string file_;
  pid_t process_ = -1;
};

/// How many sockets listen on an interface, by the kernel's own list of filters.
int listeners(const std::string& interface_name);

/// The frames that the shell's cansend would send for this text.
Frame frame(const std::string& text);

/// Frames with identifiers counting up from `first`, extended, 8 bytes.
std::vector<Frame> numbered_frames(std::uint32_t first, std::size_t count);

/// What the bus has within `first_wait`, in batches, until nothing more comes.
std::vector<Received> receive_all(Bus& bus, Timeout first_wait = a_moment);
/// Exactly `count` frames, or fewer and a failed test.
std::vector<Received> receive_exactly(Bus& bus, std::size_t count);

/// As cansend writes them, for comparing and printing.
std::vector<std::string> texts(const std::vector<Received>& received);
std::vector<std::string> texts(const std::vector<Frame>& frames);

/// vcan0, up, with no queue.
class LabTest : public testing::Test {
 protected:
  void SetUp() override;
};

/// The same, for tests that leave vcan0 in another state.
class LabTestThatChangesTheInterface : public LabTest {
 protected:
  void TearDown() override;
};

}  // namespace roio::lab

#endif
