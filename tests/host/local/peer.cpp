// Another process on a local bus, for tests: reports on stdout, one line each, and can be killed.
//
//   local_peer receive URL COUNT   until COUNT numbers are received or known lost, or 10 s of
//   silence local_peer send URL COUNT      the numbers 0..COUNT-1 as fast as they go local_peer
//   hold URL            opens the bus and neither reads nor writes
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <roio.hpp>
#include <string>

namespace {

using namespace std::chrono_literals;

void say(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

// Each frame carries its number: what is missing, doubled or out of order shows.
void receive(roio::Bus& bus, std::uint64_t count) {
  std::array<roio::Received, 256> batch;
  std::uint64_t received = 0;
  std::uint64_t lost = 0;
  std::uint64_t next = 0;
  std::uint64_t wrong = 0;
  while (received + lost < count) {
    const roio::Transfer transfer = bus.receive(batch, 10s);
    if (transfer.result != roio::Result::ok) {
      break;
    }
    for (std::size_t i = 0; i < transfer.count; ++i) {
      std::uint64_t number = 0;
      std::memcpy(&number, batch.at(i).frame.data, sizeof number);
      lost += batch.at(i).lost_before;
      next += batch.at(i).lost_before;
      wrong += number == next ? 0 : 1;
      next = number + 1;
    }
    received += transfer.count;
  }
  const roio::Statistics statistics = bus.statistics();
  say("received=" + std::to_string(received) + " lost=" + std::to_string(lost) +
      " dropped=" + std::to_string(statistics.dropped) + " wrong=" + std::to_string(wrong) +
      " outages=" + std::to_string(statistics.outages));
}

bool send(roio::Bus& bus, std::uint64_t count) {
  for (std::uint64_t number = 0; number < count; ++number) {
    roio::Frame frame{0x1004A00A, roio::FrameKind::extended, 8, {}};
    std::memcpy(frame.data, &number, sizeof number);
    if (bus.send(frame, 10s) != roio::Result::ok) {
      return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 2 ? argv[1] : "";
  const std::uint64_t count = argc > 3 ? std::stoull(argv[3]) : 0;
  roio::OpenOptions options;
  options.send_only = mode == "send";
  const auto bus = roio::open(argc > 2 ? argv[2] : "", options);
  say("open");
  if (mode == "receive") {
    receive(*bus, count);
  } else if (mode == "send") {
    const bool all = send(*bus, count);
    bus->close();
    say("sent=" + std::to_string(bus->statistics().sent) + " all=" + (all ? "yes" : "no") +
        " unsent=" + std::to_string(bus->statistics().unsent));
  } else {
    std::getchar();  // until the test closes our input, or kills us
  }
}
