// A program that forks with a bus open: the bus stays the parent's.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <roio.hpp>

#include "process.hpp"

namespace roio {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::unique_name;

constexpr Frame some_frame{0x123, FrameKind::standard, 0, {}};

// @return the first check that failed, from 1; 0: none.
int check_as_child(std::unique_ptr<Bus> bus, std::unique_ptr<Bus> other) {
  Received received{};
  const bool rows[] = {
      bus->send(some_frame, 1s) == Result::closed,
      bus->receive(received, 1s) == Result::closed,
      bus->state() == BusState::absent,
      !bus->listeners(),
      !bus->name().empty(),
  };
  bus->set_filters({});
  bus->cancel();
  bus->close();
  bus.reset();
  other.reset();
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    if (!rows[i]) {
      return static_cast<int>(i) + 1;
    }
  }
  return 0;
}

TEST(Fork, InTheChildABusIsClosedAndTheParentsGoesOn) {
  const std::string url = "local:" + unique_name();
  auto carrier = open(url);
  auto other = open(url, {.send_only = true});
  const pid_t child = ::fork();
  if (child == 0) {
    ::_exit(check_as_child(std::move(carrier), std::move(other)));
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  ASSERT_EQ(other->send(some_frame, 30s), Result::ok);
  Received received{};
  ASSERT_EQ(carrier->receive(received, 30s), Result::ok);
  EXPECT_EQ(carrier->statistics().outages + other->statistics().outages, 0U);
}

TEST(Fork, AChildThatOutlivesItsParentHoldsNobodyUp) {
  const std::string url = "local:" + unique_name();
  Peer carrier({"fork", url});
  ASSERT_EQ(carrier.line(), "open");
  const pid_t child = std::stoi(carrier.line());
  const auto receiver = open(url);
  const auto sender = open(url, {.send_only = true});
  carrier.kill();
  EXPECT_EQ(sender->send(some_frame, 30s), Result::ok);
  Received received{};
  EXPECT_EQ(receiver->receive(received, 30s), Result::ok);
  EXPECT_EQ(::kill(child, SIGKILL), 0) << "it is still there";
}

}  // namespace
}  // namespace roio
