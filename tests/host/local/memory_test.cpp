// No memory for the library's threads: the bus is absent for them, nothing aborts, and what was
// lost is counted.
#include <gtest/gtest.h>

#include <roio.hpp>
#include <thread>

#include "process.hpp"
#include "scarce_memory.hpp"

namespace roio {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::unique_name;

bool becomes(const Bus& bus, BusState state) {
  for (const auto end = std::chrono::steady_clock::now() + 30s;
       std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(1ms)) {
    if (bus.state() == state) {
      return true;
    }
  }
  return false;
}

TEST(ScarceMemory, ABusIsAbsentUntilThereIsSomeAndWhatItLostIsCounted) {
  test::is_spared = true;  // the program's own thread
  const std::string url = "local:" + unique_name();
  const auto bus = open(url);  // the hub is here, too
  Peer other({"hold", url});
  ASSERT_EQ(other.line(), "open");
  Peer sender({"pour", url, "1"});
  ASSERT_EQ(sender.line(), "open");
  std::array<Received, 256> batch;
  std::uint64_t received = 0;
  std::uint64_t lost = 0;
  const auto take = [&](Timeout timeout) {
    const Transfer transfer = bus->receive(batch, timeout);
    for (std::size_t i = 0; i < transfer.count; ++i) {
      lost += batch.at(i).lost_before;
    }
    received += transfer.count;
    return transfer.result;
  };
  ASSERT_EQ(take(30s), Result::ok);
  test::memory_is_scarce = true;
  EXPECT_TRUE(becomes(*bus, BusState::absent));
  test::memory_is_scarce = false;
  EXPECT_TRUE(becomes(*bus, BusState::active));
  sender.tell("");
  std::uint64_t sent = 0;
  const std::string line = sender.line();
  ASSERT_EQ(std::sscanf(line.c_str(), "sent=%lu unsent=0", &sent), 1) << line;
  while (received + lost < sent && take(30s) == Result::ok) {
  }
  EXPECT_EQ(received + lost, sent);
  EXPECT_GE(bus->statistics().outages, 1U);
  EXPECT_EQ(bus->statistics().dropped, lost);
}

}  // namespace
}  // namespace roio
