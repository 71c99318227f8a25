// A program that forks with a bridge open: it stays the parent's. The child must not wait for
// threads that it does not have, nor speak to the board.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <roio/bridge.hpp>
#include <roio/bus.hpp>

#include "pty_bridge.hpp"

namespace roio::test {
namespace {

using namespace std::chrono_literals;

constexpr Frame some_frame{0x123, FrameKind::standard, 0, {}};

TEST(SerialFork, InTheChildTheBridgeIsClosedAndTheParentsGoesOn) {
  PtyBridge board;
  auto bus = open("serial:" + board.path());
  const pid_t child = ::fork();
  if (child == 0) {
    const bool is_none = bridge_of(*bus) == nullptr;
    const bool is_closed = bus->send(some_frame, 1s) == Result::closed;
    bus.reset();
    ::_exit(is_none && is_closed ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_NO_THROW(static_cast<void>(bridge_of(*bus)->counters(30s)));
  EXPECT_EQ(bridge_of(*bus)->line_counters().sessions, 1U);
}

// It would keep the port locked.
TEST(SerialFork, AChildThatOutlivesTheBusHasNotThePort) {
  PtyBridge board;
  const std::string url = "serial:" + board.path();
  auto bus = open(url);
  const pid_t child = ::fork();
  if (child == 0) {
    for (;;) {
      ::pause();
    }
  }
  bus.reset();
  EXPECT_NO_THROW(open(url));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

}  // namespace
}  // namespace roio::test
