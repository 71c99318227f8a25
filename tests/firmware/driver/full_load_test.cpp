// A bus that is never idle, and a program that comes when it can.
#include <random>

#include "rig.hpp"
#include "sanitizers.hpp"
#include "seed.hpp"
#include "soak.hpp"

namespace roio::test {
namespace {

// In scripts/soak a million for the four drivers below.
const std::uint32_t frames_each = is_soak() ? 250'000 : is_instrumented ? 20'000 : 50'000;

/// Keeps the bus at 100 %: frames of 0 to 8 bytes, to the node and to everybody in its subnet,
/// mixed.
class FullBus {
 public:
  FullBus(sim::HostNode& sender, std::mt19937& generator, std::uint32_t frames)
      : sender_(sender), generator_(generator), frames_(frames) {
    sender_.on_sent([this](const Frame&) { refill(); });
    for (int i = 0; i < 3; ++i) {
      refill();
    }
  }

  [[nodiscard]] bool done() const { return sent.size() == frames_ && sender_.waiting() == 0; }

  std::vector<Frame> sent;

 private:
  void refill() {
    if (sent.size() == frames_) {
      return;
    }
    const auto number = static_cast<std::uint32_t>(sent.size());
    const bool broadcast = up_to(generator_, 3) == 0;
    Frame frame = numbered(number, static_cast<std::uint8_t>(up_to(generator_, 8)),
                           broadcast ? to_everybody : to_own);
    frame.id |= number & 0xFF;  // the source changes, so that frames without data differ, too
    for (unsigned i = 4; i < frame.length; ++i) {
      frame.data[i] = static_cast<std::uint8_t>(generator_());
    }
    sent.push_back(frame);
    sender_.send(frame);
  }

  sim::HostNode& sender_;
  std::mt19937& generator_;
  std::uint32_t frames_;
};

/// Two frames without data take 272 us at 500 kbit/s; the first is out of the chip 16 SPI bytes
/// after the call begins.
constexpr std::uint32_t bearable_us = 250;
constexpr std::uint32_t unbearable_us = 1500;

template <bool WithLine, std::uint8_t RxQueue>
void run_full_bus(std::uint32_t longest_absence_us, bool loses) {
  std::mt19937 generator = seeded_generator();
  Rig<WithLine, RxQueue> rig;
  rig.begin();
  FullBus full(rig.peer, generator, frames_each);
  std::vector<Frame> received;
  while (!full.done()) {
    Frame frame{};
    // All there is, and then away: the frames of a queue cost no time.
    while (rig.can.receive(frame) == Status::ok) {
      received.push_back(frame);
    }
    rig.bus.run_for(microseconds(1 + up_to(generator, longest_absence_us - 1)));
  }
  for (const Frame& frame : rig.receive_all()) {
    received.push_back(frame);
  }
  const auto& counters = rig.can.counters();
  const std::uint64_t lost = rig.chip.events().overflowed;
  EXPECT_EQ(full.sent.size(), frames_each);
  EXPECT_EQ(received.size() + lost, frames_each) << "each frame was delivered, or met full buffers";
  EXPECT_TRUE(received == rig.accepted) << "not in order";
  EXPECT_EQ(counters.received, received.size());
  EXPECT_EQ(counters.foreign + counters.discarded + counters.chip_losses, 0U);
  EXPECT_EQ(counters.line_losses, 0U);
  EXPECT_EQ(rig.can.line_is_on(), WithLine) << "never taken for one that is off";
  EXPECT_LE(counters.overflows, lost) << "the chip cannot say how many, only that some were lost";
  EXPECT_EQ(counters.overflows > 0, loses);
  EXPECT_EQ(lost > 0, loses);
  if (!loses) {
    EXPECT_TRUE(received == full.sent);
  }
  const sim::BusStatistics& bus = rig.bus.statistics();
  EXPECT_GT(bus.busy, rig.bus.now() * 99 / 100) << "the bus was not full";
  std::cout << received.size() << " of " << frames_each << " received, " << lost << " lost, "
            << counters.overflows << " losses noticed, in "
            << std::chrono::duration_cast<std::chrono::seconds>(rig.bus.now()).count()
            << " simulated seconds\n";
}

TEST(FullLoad, PollingLosesNothingThatTwoBuffersCanBear) {
  run_full_bus<false, 0>(bearable_us, false);
}
TEST(FullLoad, WithAnInterruptLineNeither) {
  run_full_bus<true, 0>(bearable_us, false);
}
TEST(FullLoad, WithAQueueNeither) {
  run_full_bus<false, 4>(bearable_us, false);
}
TEST(FullLoad, WithAQueueAndAnInterruptLineNeither) {
  run_full_bus<true, 4>(bearable_us, false);
}

TEST(FullLoad, BeyondThatTheOrderHoldsAndTheLossIsTold) {
  run_full_bus<false, 0>(unbearable_us, true);
}
TEST(FullLoad, BeyondThatWithAnInterruptLineToo) {
  run_full_bus<true, 0>(unbearable_us, true);
}
TEST(FullLoad, BeyondThatWithAQueueToo) {
  run_full_bus<false, 4>(unbearable_us, true);
}
TEST(FullLoad, BeyondThatWithAQueueAndAnInterruptLineToo) {
  run_full_bus<true, 4>(unbearable_us, true);
}

}  // namespace
}  // namespace roio::test
