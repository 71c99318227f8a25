// A saturated bus over a line that is fast enough for it: nothing lost, in order.
#include <deque>

#include "bridge_rig.hpp"

namespace roio::test {
namespace {

/// Bits that alternate are hardly ever stuffed, so the frames are short.
Frame numbered(std::uint32_t number, int length) {
  Frame frame = extended(0x15555555, Bytes(static_cast<std::size_t>(length), 0x55));
  frame.id = 0x15540000 | ((number * 0x5555U) & 0xFFFF);
  for (int i = 0; i < length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i % 32));
  }
  return frame;
}

/// Of two that send these, each wins arbitration as often as the other.
Frame mixed(std::uint32_t number, int length, std::uint32_t sender) {
  Frame frame = numbered(number, length);
  const std::uint32_t hash = (number * 2 + sender) * 2654435761U;
  frame.id = 0x15555554 ^ (hash & 0x00AAAAAA) ^ sender;
  return frame;
}

/// Keeps the window full, and takes what RESULTS says, as a PC should.
class Sender {
 public:
  explicit Sender(BridgeRig& rig) : rig_(rig) {}
  void offer(const Frame& frame) { waiting_.push_back(frame); }
  std::size_t waiting() const { return waiting_.size(); }
  std::uint64_t done = 0;
  std::uint64_t wrong = 0;
  std::uint64_t again = 0;
  /// Looks at the records that have come, and sends what it may.
  void work() {
    for (; seen_ < rig_.records.size(); ++seen_) {
      const Bytes& body = rig_.records[seen_];
      if (body[0] != static_cast<std::uint8_t>(serial::Up::results)) {
        continue;
      }
      const std::uint8_t next = body[2];
      next_ = next;
      again += body[3];
      const std::uint32_t slots = serial::get32(body.data() + 4);
      while (pending_ > 0 && static_cast<std::uint8_t>(next - base_) > 0 &&
             static_cast<std::uint8_t>(next - base_) <= 16) {
        const std::uint32_t outcome = (slots >> (2 * (base_ % 16))) & 3;
        if (outcome == 0) {
          break;
        }
        wrong += outcome != 1;
        ++done;
        ++base_;
        --pending_;
      }
    }
    while (pending_ < 16 && untaken_bytes() < 170 - 22 && !waiting_.empty()) {
      rig_.send(waiting_.front());
      waiting_.pop_front();
      ++pending_;
    }
  }

 private:
  BridgeRig& rig_;
  std::deque<Frame> waiting_;
  std::size_t seen_ = 0;
  std::uint8_t base_ = 0;
  std::uint8_t next_ = 0;
  [[nodiscard]] int untaken_bytes() const {
    return static_cast<std::uint8_t>(rig_.next_down - next_) *
           (waiting_.empty() ? 0 : 11 + waiting_.front().length);
  }
  int pending_ = 0;
};

TEST(BridgeLoad, Up) {
  BridgeRig rig;
  rig.hello();
  ASSERT_EQ(rig.request(serial::Down::speed, bytes_of(1'000'000)), Status::ok);
  rig.bus.run_for(5ms);
  rig.poll();
  rig.bus.run_for(5ms);
  for (int length = 0; length <= 8; length += 4) {
    std::uint32_t sent = 0;
    rig.records.clear();
    const auto give = [&] { rig.node.send(numbered(sent++, length)); };
    rig.node.on_sent([&](const Frame&) { give(); });
    give();
    give();
    const sim::BusStatistics before = rig.bus.statistics();
    for (int i = 0; i < 20; ++i) {
      rig.bus.run_for(50ms);
      rig.poll();
    }
    const sim::BusStatistics after = rig.bus.statistics();
    rig.node.on_sent(nullptr);
    rig.bus.run_for(20ms);
    const auto frames = rig.frames();
    std::printf(
        "length %d: load %.3f, sent %u, got %zu, damaged %d, dropped %u, overflows %u accepted "
        "%llu\n",
        length, std::chrono::duration<double>(after.busy - before.busy).count(), sent,
        frames.size(), rig.damaged, rig.counter(0), rig.counter(1),
        static_cast<unsigned long long>(rig.board.chip().events().accepted));
  }
}

TEST(BridgeLoad, Down) {
  for (const bool both : {false, true}) {
    for (int length = 0; length <= 8; length += 4) {
      BridgeRig rig;
      rig.hello();
      ASSERT_EQ(rig.request(serial::Down::speed, bytes_of(1'000'000)), Status::ok);
      rig.bus.run_for(5ms);
      rig.poll();
      rig.bus.run_for(5ms);
      rig.records.clear();
      rig.on_bus.clear();
      Sender sender(rig);
      std::uint32_t sent = 0;
      std::uint32_t up = 0;
      if (both) {
        const auto give = [&] {
          Frame frame = mixed(up++, length, 0);
          rig.node.send(frame);
        };
        rig.node.on_sent([&, give](const Frame&) { give(); });
        give();
      }
      const sim::BusStatistics before = rig.bus.statistics();
      for (int i = 0; i < 10000; ++i) {
        while (sender.waiting() < 20) {
          Frame frame = mixed(sent++, length, 1);
          sender.offer(frame);
        }
        sender.work();
        rig.bus.run_for(100us);
        if (i % 1000 == 0)
          rig.poll();
      }
      const sim::BusStatistics after = rig.bus.statistics();
      rig.node.on_sent(nullptr);
      const auto frames = rig.frames();
      std::printf(
          "both %d length %d: load %.3f, done %llu, wrong %llu again %llu on bus %zu; up %u got "
          "%zu damaged %d, dropped %u, overflows %u damaged %u overruns %u\n",
          both, length, std::chrono::duration<double>(after.busy - before.busy).count(),
          static_cast<unsigned long long>(sender.done),
          static_cast<unsigned long long>(sender.wrong),
          static_cast<unsigned long long>(sender.again), rig.on_bus.size(), up, frames.size(),
          rig.damaged, rig.counter(0), rig.counter(1), rig.counter(9), rig.counter(10));
    }
  }
}

}  // namespace
}  // namespace roio::test
