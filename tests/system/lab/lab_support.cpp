#include "lab_support.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace roio::lab {
namespace {

bool interface_is_fresh = false;

std::string contents(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string temporary_file() {
  std::string name = "/run/roio-peer.XXXXXX";
  const int file = ::mkstemp(name.data());
  if (file < 0) {
    throw std::runtime_error("no temporary file in /run; these tests run in scripts/lab");
  }
  ::close(file);
  return name;
}

std::string text(const Frame& frame) {
  return to_text(frame);
}

}  // namespace

std::string shell(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");  // NOLINT(cert-env33-c): a shell is what is meant
  if (pipe == nullptr) {
    ADD_FAILURE() << "no shell for: " << command;
    return {};
  }
  std::string output;
  std::array<char, 4096> part;
  for (std::size_t size = 0; (size = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
    output.append(part.data(), size);
  }
  EXPECT_EQ(::pclose(pipe), 0) << command << "\n" << output;
  return output;
}

bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

Peer::Peer(const std::string& command) : file_(temporary_file()) {
  process_ = ::fork();
  if (process_ == 0) {
    ::setpgid(0, 0);
    const int out = ::open(file_.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    ::dup2(out, STDOUT_FILENO);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  ::setpgid(process_, process_);
}

Peer::~Peer() {
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  std::remove(file_.c_str());
}

int Peer::wait() {
  int status = -1;
  const bool ended = eventually([&] { return ::waitpid(process_, &status, WNOHANG) == process_; });
  if (!ended) {
    return -1;
  }
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string Peer::output() const {
  return contents(file_);
}

int listeners(const std::string& interface_name) {
  std::istringstream list(contents("/proc/net/can/rcvlist_all"));
  int count = 0;
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    count += first == interface_name ? 1 : 0;
  }
  return count;
}

Frame frame(const std::string& text) {
  const Parsed<Frame> parsed = parse_frame_text(text);
  if (!parsed) {
    throw std::invalid_argument(text + ": " + parsed.error().message);
  }
  return *parsed;
}

std::vector<Frame> numbered_frames(std::uint32_t first, std::size_t count) {
  std::vector<Frame> frames(count);
  for (std::size_t i = 0; i < count; ++i) {
    frames[i] = Frame{
        first + static_cast<std::uint32_t>(i), FrameKind::extended, 8, {1, 2, 3, 4, 5, 6, 7, 8}};
  }
  return frames;
}

std::vector<Received> receive_all(Bus& bus, Timeout first_wait) {
  std::vector<Received> all;
  std::array<Received, 100> batch;
  for (Timeout wait = first_wait;;) {
    const Transfer transfer = bus.receive(batch, wait);
    if (transfer.result != Result::ok) {
      return all;
    }
    all.insert(all.end(), batch.begin(), batch.begin() + static_cast<long>(transfer.count));
    wait = a_moment;
  }
}

std::vector<Received> receive_exactly(Bus& bus, std::size_t count) {
  std::vector<Received> all(count);
  std::size_t have = 0;
  while (have < count) {
    const Transfer transfer = bus.receive(std::span(all).subspan(have), patience);
    if (transfer.result != Result::ok) {
      ADD_FAILURE() << "received " << have << " of " << count << " frames, then "
                    << to_string(transfer.result);
      all.resize(have);
      return all;
    }
    have += transfer.count;
  }
  return all;
}

std::vector<std::string> texts(const std::vector<Received>& received) {
  std::vector<std::string> result;
  std::transform(received.begin(), received.end(), std::back_inserter(result),
                 [](const Received& one) { return text(one.frame); });
  return result;
}

std::vector<std::string> texts(const std::vector<Frame>& frames) {
  std::vector<std::string> result;
  std::transform(frames.begin(), frames.end(), std::back_inserter(result), text);
  return result;
}

void LabTest::SetUp() {
  if (!interface_is_fresh) {
    shell(
        "printf 'link del vcan0\\nlink add vcan0 type vcan\\nlink set vcan0 up\\n' |"
        " ip -force -batch - 2>/dev/null; ip link show up dev vcan0 >/dev/null");
    interface_is_fresh = true;
  }
}

void LabTestThatChangesTheInterface::TearDown() {
  interface_is_fresh = false;
}

}  // namespace roio::lab
