// Another process on a local bus, for tests: reports on stdout, one line each, and can be killed.
//
// "local_peer receive URL COUNT": until COUNT numbers are received or known lost, or 10 s of
// silence. "local_peer send URL COUNT": the numbers 0..COUNT-1, as fast as they go. "local_peer
// hold URL": opens the bus and neither reads nor writes, until its input ends. "local_peer listen
// URL": carries the bus for nobody; says for all senders together what came, once its input has
// told it how many frames there were. "local_peer pour URL SENDER": carries it for nobody; sends
// until its input ends. "local_peer shot URL SENDER": the same with 20 frames, at once.
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <map>
#include <roio.hpp>
#include <string>
#include <thread>

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

// Frames of many senders, each with its sender and its number: what is missing, doubled or out of
// order shows.
class Ledger {
 public:
  void note(const roio::Received& received) {
    std::uint64_t word = 0;
    std::memcpy(&word, received.frame.data, sizeof word);
    std::uint64_t& next = next_[word >> number_bits];
    const std::uint64_t number = word & ((UINT64_C(1) << number_bits) - 1);
    wrong_ += number < next ? 1U : 0U;
    missing_ += number > next ? number - next : 0;
    next = number + 1;
    ++received_;
    lost_ += received.lost_before;
  }
  [[nodiscard]] std::uint64_t told() const { return received_ + lost_; }
  [[nodiscard]] std::string text() const {
    return "received=" + std::to_string(received_) + " lost=" + std::to_string(lost_) +
           " missing=" + std::to_string(missing_) + " wrong=" + std::to_string(wrong_);
  }

  static roio::Frame frame(std::uint64_t sender, std::uint64_t number) {
    roio::Frame frame{0x1004A00A, roio::FrameKind::extended, 8, {}};
    const std::uint64_t word = sender << number_bits | number;
    std::memcpy(frame.data, &word, sizeof word);
    return frame;
  }

 private:
  static constexpr unsigned number_bits = 40;

  std::map<std::uint64_t, std::uint64_t> next_;
  std::uint64_t received_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t missing_ = 0;
  std::uint64_t wrong_ = 0;
};

void listen(roio::Bus& bus) {
  std::atomic<std::uint64_t> expected{UINT64_MAX};
  std::thread input([&] {
    std::uint64_t count = 0;
    std::cin >> count;
    expected = count;
    bus.cancel();
  });
  Ledger ledger;
  std::array<roio::Received, 256> batch;
  const auto take = [&](roio::Timeout timeout) {
    const roio::Transfer transfer = bus.receive(batch, timeout);
    for (std::size_t i = 0; i < transfer.count; ++i) {
      ledger.note(batch.at(i));
    }
    return transfer.result;
  };
  while (take(roio::forever) != roio::Result::cancelled) {
  }
  input.join();
  bus.resume();
  while (ledger.told() < expected && take(20s) == roio::Result::ok) {
  }
  while (take(roio::no_wait) == roio::Result::ok) {  // what came twice
  }
  say(ledger.text());
}

void pour(roio::Bus& bus, std::uint64_t sender, std::uint64_t most) {
  std::atomic<bool> over{false};
  std::thread input([&] {
    if (most == UINT64_MAX) {
      std::getchar();
      over = true;
    }
  });
  std::uint64_t number = 0;
  while (!over && number < most &&
         bus.send(Ledger::frame(sender, number), 30s) == roio::Result::ok) {
    ++number;
  }
  input.join();
  bus.close();
  say("sent=" + std::to_string(number) + " unsent=" + std::to_string(bus.statistics().unsent));
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
  constexpr std::uint64_t frames_of_a_shot = 20;
  roio::OpenOptions options;
  options.send_only = mode == "send" || mode == "pour" || mode == "shot";
  if (mode == "listen" || mode == "pour" || mode == "shot") {
    options.carry = roio::Carry::never;
  }
  if (mode == "carry") {
    options.carry = roio::Carry::always;
  }
  options.open_timeout = 30s;
  const auto bus = roio::open(argc > 2 ? argv[2] : "", options);
  say("open");
  if (mode == "receive") {
    receive(*bus, count);
  } else if (mode == "send") {
    const bool all = send(*bus, count);
    bus->close();
    say("sent=" + std::to_string(bus->statistics().sent) + " all=" + (all ? "yes" : "no") +
        " unsent=" + std::to_string(bus->statistics().unsent));
  } else if (mode == "fork") {
    const pid_t child = ::fork();
    if (child == 0) {
      ::pause();
    }
    say(std::to_string(child));
    std::getchar();
  } else if (mode == "listen") {
    listen(*bus);
  } else if (mode == "pour" || mode == "shot") {
    pour(*bus, count, mode == "pour" ? UINT64_MAX : frames_of_a_shot);
  } else {
    std::getchar();  // until the test closes our input, or kills us
  }
}
