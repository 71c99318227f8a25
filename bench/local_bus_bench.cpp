// The local bus between processes: how many frames a second without losing one, how long one frame
// takes when nothing else goes on, and what programs cost that are on the bus and want none of it.
// Prints a table; exits with 1 when a frame was lost or wrong.
//
//   local_bus_bench [FRAMES [ROUNDS]]
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <roio.hpp>
#include <string>
#include <vector>

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int receivers = 2;
constexpr std::uint64_t idle_frames = 10'000;
constexpr std::array<std::size_t, 2> percentiles = {50, 99};

std::string bus_url(const char* what) {
  return "local:bench-" + std::string(what) + "-" + std::to_string(::getpid());
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

roio::Frame numbered(std::uint64_t number) {
  roio::Frame frame{0x1004A00A, roio::FrameKind::extended, 8, {}};
  std::memcpy(frame.data, &number, sizeof number);
  return frame;
}

/// Another process; forked while this one has no threads.
template <typename Function>
pid_t start_process(Function&& function) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::_exit(function() ? 0 : 1);
  }
  return pid;
}

bool ended_well(pid_t pid) {
  int status = 0;
  return ::waitpid(pid, &status, 0) == pid && status == 0;
}

void tell(int pipe_end) {
  const char ready = 'r';
  static_cast<void>(!::write(pipe_end, &ready, 1));
}

void await(int pipe_end) {
  char ready = 0;
  static_cast<void>(!::read(pipe_end, &ready, 1));
}

/// Whether all numbers came, each once and in order.
bool receive_all(const std::string& url, std::uint64_t count, int ready) {
  const auto bus = roio::open(url);
  tell(ready);
  std::array<roio::Received, 256> batch;
  std::uint64_t next = 0;
  while (next < count) {
    const roio::Transfer transfer = bus->receive(batch, 10s);
    if (transfer.result != roio::Result::ok) {
      break;
    }
    for (std::size_t i = 0; i < transfer.count; ++i) {
      std::uint64_t number = 0;
      std::memcpy(&number, batch.at(i).frame.data, sizeof number);
      if (number != next++) {
        return false;
      }
    }
  }
  return next == count;
}

bool flood(std::uint64_t count) {
  const std::string url = bus_url("flood");
  std::array<int, 2> ready{};
  if (::pipe(ready.data()) != 0) {
    return false;
  }
  std::vector<pid_t> processes;
  for (int i = 0; i < receivers; ++i) {
    processes.push_back(start_process([&] { return receive_all(url, count, ready[1]); }));
    await(ready[0]);
  }
  const auto bus = roio::open(url, {.send_only = true});
  const auto start = Clock::now();
  bool sent = true;
  for (std::uint64_t number = 0; number < count && sent; ++number) {
    sent = bus->send(numbered(number), 10s) == roio::Result::ok;
  }
  bool received = true;
  for (const pid_t process : processes) {
    received = ended_well(process) && received;
  }
  const double took = seconds_since(start);
  bus->close();
  std::printf(
      "flood      1 sender, %d receivers, one process each: %llu frames in %.3f s, %.0f/s, %s\n",
      receivers, static_cast<unsigned long long>(count), took, static_cast<double>(count) / took,
      sent && received ? "none lost, all in order" : "LOST OR WRONG");
  return sent && received;
}

/// Sends back what it gets, until it gets nothing for a while.
bool echo(const std::string& url, int ready) {
  const auto bus = roio::open(url);
  tell(ready);
  roio::Received received{};
  while (bus->receive(received, 2s) == roio::Result::ok) {
    if (bus->send(received.frame) != roio::Result::ok) {
      return false;
    }
  }
  return true;
}

bool latency(std::size_t rounds) {
  const std::string url = bus_url("latency");
  std::array<int, 2> ready{};
  if (::pipe(ready.data()) != 0) {
    return false;
  }
  const pid_t process = start_process([&] { return echo(url, ready[1]); });
  await(ready[0]);
  const auto bus = roio::open(url);
  std::vector<double> one_way_us;
  for (std::size_t i = 0; i < rounds; ++i) {
    ::usleep(500);  // idle: the threads of both sides are asleep
    const auto start = Clock::now();
    roio::Received received{};
    if (bus->send(numbered(i)) != roio::Result::ok ||
        bus->receive(received, 2s) != roio::Result::ok) {
      std::printf("latency    LOST\n");
      return false;
    }
    one_way_us.push_back(seconds_since(start) * 1e6 / 2);
  }
  std::sort(one_way_us.begin(), one_way_us.end());
  std::printf("latency    idle bus, two processes, one way (half a round trip), %zu rounds:",
              rounds);
  for (const std::size_t percentile : percentiles) {
    std::printf(" p%zu %.0f us", percentile, one_way_us.at(one_way_us.size() * percentile / 100));
  }
  std::printf("\n");
  return ended_well(process);
}

// --- programs that want nothing ------------------------------------------------------------------

/// Processor time and sleeps of a process that has ended well.
struct Cost {
  double us = 0;
  long sleeps = 0;
};

Cost cost_of(pid_t pid) {
  int status = 0;
  rusage used{};
  if (::wait4(pid, &status, 0, &used) != pid || status != 0) {
    return {};
  }
  const auto us = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_usec);
  };
  return {us(used.ru_utime) + us(used.ru_stime), used.ru_nvcsw};
}

/// Buses that filter all out, in one process, until `over` can be read.
bool idle(const std::string& url, int clients, int ready, int over) {
  constexpr std::array nobodys{roio::SocketCanFilter{0x7FF, 0x7FF}};
  std::vector<std::unique_ptr<roio::Bus>> buses;
  for (int i = 0; i < clients; ++i) {
    buses.push_back(roio::open(url, {.carry = roio::Carry::never}));
    buses.back()->set_filters(nobodys);
  }
  tell(ready);
  await(over);
  return true;
}

bool carry(const std::string& url, int ready, int over) {
  const auto bus = roio::open(url, {.send_only = true, .carry = roio::Carry::always});
  tell(ready);
  await(over);
  return true;
}

/// 2,000 frames a second from one program to another; others are there.
bool beside_idle(int clients, std::uint64_t count) {
  const std::string url = bus_url("idle");
  std::array<int, 2> ready{};
  std::array<int, 2> over{};
  if (::pipe(ready.data()) != 0 || ::pipe(over.data()) != 0) {
    return false;
  }
  const pid_t hub = start_process([&] { return carry(url, ready[1], over[0]); });
  await(ready[0]);
  const pid_t others = start_process([&] { return idle(url, clients, ready[1], over[0]); });
  await(ready[0]);
  const pid_t receiver = start_process([&] { return receive_all(url, count, ready[1]); });
  await(ready[0]);
  const auto bus = roio::open(url, {.send_only = true, .carry = roio::Carry::never});
  bool sent = true;
  for (std::uint64_t number = 0; number < count && sent; ++number) {
    sent = bus->send(numbered(number), 10s) == roio::Result::ok;
    ::usleep(500);
  }
  const bool received = ended_well(receiver);
  tell(over[1]);
  tell(over[1]);
  const Cost of_hub = cost_of(hub);
  const Cost of_others = cost_of(others);
  const auto frames = static_cast<double>(count);
  std::printf(
      "idle       %3d programs that want nothing: the carrier %.1f us and %.1f sleeps a frame, "
      "they together %.2f us and %.2f sleeps, %s\n",
      clients, of_hub.us / frames, static_cast<double>(of_hub.sleeps) / frames,
      of_others.us / frames, static_cast<double>(of_others.sleeps) / frames,
      sent && received ? "none lost" : "LOST");
  return sent && received;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t frames = argc > 1 ? std::stoull(argv[1]) : 100'000;
  const std::size_t rounds = argc > 2 ? std::stoul(argv[2]) : 2'000;
  bool all_there = flood(frames);
  all_there = latency(rounds) && all_there;
  for (const int clients : {0, 50, 200}) {
    all_there = beside_idle(clients, idle_frames) && all_there;
  }
  return all_there ? 0 : 1;
}
