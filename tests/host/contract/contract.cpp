#include "contract.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <iomanip>

namespace roio {

bool operator==(const Frame& a, const Frame& b) {
  return a.kind == b.kind && a.id == b.id && a.length == b.length &&
         (is_remote(a.kind) || std::equal(a.data, a.data + a.length, b.data));
}

std::ostream& operator<<(std::ostream& out, const Frame& frame) {
  const auto flags = out.flags();
  out << "kind " << static_cast<int>(frame.kind) << " id " << std::hex << frame.id << " length "
      << std::dec << int{frame.length} << std::hex;
  for (int i = 0; i < std::min<int>(frame.length, max_data_length); ++i) {
    out << ' ' << int{frame.data[i]};
  }
  out.flags(flags);
  return out;
}

}  // namespace roio

namespace roio::test {

std::vector<Backend> backends_where(bool Backend::*trait) {
  std::vector<Backend> chosen = backends();
  std::erase_if(chosen, [trait](const Backend& backend) { return !(backend.*trait); });
  return chosen;
}

Frame numbered(std::uint32_t number, std::uint32_t id) {
  Frame frame{id, FrameKind::extended, sizeof number, {}};
  std::memcpy(frame.data, &number, sizeof number);
  return frame;
}

std::uint32_t number_of(const Frame& frame) {
  std::uint32_t number = 0;
  std::memcpy(&number, frame.data, sizeof number);
  return number;
}

std::vector<Received> receive_exactly(Bus& bus, std::size_t count) {
  std::vector<Received> received(count);
  std::size_t so_far = 0;
  while (so_far < count) {
    const Transfer transfer = bus.receive(std::span(received).subspan(so_far), guard);
    if (transfer.result != Result::ok) {
      ADD_FAILURE() << "expected " << count << " frames, received " << so_far << ", then "
                    << to_string(transfer.result);
      break;
    }
    so_far += transfer.count;
  }
  received.resize(so_far);
  return received;
}

std::vector<Frame> frames_of(const std::vector<Received>& received) {
  std::vector<Frame> frames;
  frames.reserve(received.size());
  for (const Received& one : received) {
    frames.push_back(one.frame);
  }
  return frames;
}

void expect_silence(Bus& bus) {
  Received received{};
  EXPECT_EQ(bus.receive(received, moment), Result::timeout) << "received " << received.frame;
}

void send_all(Bus& bus, const std::vector<Frame>& frames) {
  const Transfer transfer = bus.send(frames, guard);
  ASSERT_EQ(transfer.result, Result::ok) << to_string(transfer.result);
  ASSERT_EQ(transfer.count, frames.size());
}

bool is_readable(const Bus& bus, std::chrono::milliseconds timeout) {
  pollfd entry{bus.fd(), POLLIN, 0};
  return ::poll(&entry, 1, static_cast<int>(timeout.count())) == 1 && (entry.revents & POLLIN) != 0;
}

}  // namespace roio::test
