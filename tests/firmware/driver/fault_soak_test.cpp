// A long time with everything going wrong: bit errors on the bus, resets of the chip, a cable that
// falls off and is plugged in again, at any moment. Nothing hangs, no wrong frame is handed out or
// sent, and the counters add up.
//
// What no driver can notice is left to the second test: a flipped bit in the middle of a frame on
// SPI, which has no check. There the promise is less: no hang, and all well again once the flips
// stop.
#include <random>
#include <set>

#include "rig.hpp"
#include "sanitizers.hpp"
#include "seed.hpp"

namespace roio::test {
namespace {

/// Simulated seconds; scripts/soak asks for an hour.
std::int64_t soak_seconds() {
  const char* const given = std::getenv("ROIO_SOAK_SECONDS");
  constexpr std::int64_t usual = is_instrumented ? 10 : 30;
  return given != nullptr ? std::strtoll(given, nullptr, 10) : usual;
}

// From different sources: two nodes that send one identifier with different data never come to an
// end.
constexpr std::uint32_t from_peer = to_own | 9;
constexpr std::uint32_t from_driver = to_own | 2;
constexpr std::uint32_t urgent_from_driver = urgent_to_own | 2;

/// A frame that shows whether any of its bytes is wrong: number, and its complement.
Frame checked(std::uint32_t number, std::uint32_t id) {
  Frame frame = numbered(number, 8, id);
  for (unsigned i = 0; i < 4; ++i) {
    frame.data[4 + i] = static_cast<std::uint8_t>(~frame.data[i]);
  }
  return frame;
}

template <bool WithLine>
class Soak {
 public:
  explicit Soak(std::mt19937& generator) : generator_(generator) {
    rig_.chip.on_sent([this](const Frame& frame) { check_sent(frame); });
    rig_.wire.on_step([this] { at_step(); });
  }

  void run(sim::SimTime span) {
    const sim::SimTime end = rig_.bus.now() + span;
    rig_.bus.set_bit_errors(2e-5, static_cast<std::uint32_t>(generator_()));
    while (rig_.bus.now() < end && !testing::Test::HasFailure()) {
      plan();
      traffic();
      serve();
      rig_.bus.run_for(microseconds(20 + up_to(generator_, 400)));
    }
    calm_down();
  }

  void check() const {
    const auto& counters = rig_.can.counters();
    const std::size_t missing = rig_.accepted.size() - received_;
    EXPECT_LE(missing, 2 * begins_) << "two frames for each time that the chip was set up again";
    EXPECT_EQ(counters.received, received_);
    // Sent: each frame once, and told so, or not known.
    EXPECT_EQ(counters.sent + counters.not_sent + counters.unknown, submitted_);
    EXPECT_EQ(counters.not_sent, 0U);
    EXPECT_LE(counters.sent, on_wire_.size()) << "told as sent, and was not";
    EXPECT_LE(on_wire_.size(), counters.sent + counters.unknown);
    EXPECT_GT(counters.chip_losses, 0U);
    EXPECT_GT(received_, 100U);
    std::cout << received_ << " received, " << missing << " lost with the chip, "
              << rig_.chip.events().overflowed << " overflowed, " << counters.sent << " sent, "
              << counters.unknown << " unknown, " << counters.chip_losses << " chip losses, "
              << resets_ << " resets, " << unplugged_ << " times unplugged, "
              << rig_.bus.statistics().flipped_bits << " bits flipped, in "
              << std::chrono::duration_cast<std::chrono::seconds>(rig_.bus.now()).count()
              << " simulated seconds\n";
  }

 private:
  /// Faults come at any SPI step within the next while, or when none is under way.
  void plan() {
    if (up_to(generator_, 2'000) == 0) {
      reset_in_ = 1 + up_to(generator_, 60);
    }
    if (plugged_ && up_to(generator_, 2'000) == 0) {
      unplug_in_ = 1 + up_to(generator_, 60);
    }
    if (!plugged_ && rig_.bus.now() >= plug_in_at_) {
      plug_in_in_ = 1 + up_to(generator_, 60);
    }
  }

  void at_step() {
    if (reset_in_ > 0 && --reset_in_ == 0) {
      ++resets_;
      rig_.chip.reset_pin();
    }
    if (unplug_in_ > 0 && --unplug_in_ == 0) {
      ++unplugged_;
      plugged_ = false;
      plug_in_at_ = rig_.bus.now() + milliseconds(1 + up_to(generator_, 40));
      rig_.wire.set_fault(up_to(generator_, 1) == 0 ? sim::SpiWire::Fault::stuck_low
                                                    : sim::SpiWire::Fault::stuck_high);
    }
    if (plug_in_in_ > 0 && --plug_in_in_ == 0) {
      plug_in();
    }
  }

  void plug_in() {
    plugged_ = true;
    rig_.wire.set_fault(sim::SpiWire::Fault::none);
  }

  void traffic() {
    if (rig_.peer.waiting() < 4 && up_to(generator_, 1) == 0) {
      rig_.peer.send(checked(peer_number_++, from_peer));
    }
    if (up_to(generator_, 2) == 0) {
      const bool urgent = up_to(generator_, 3) == 0;
      const Status status =
          rig_.can.send(checked(submitted_, urgent ? urgent_from_driver : from_driver));
      submitted_ += status == Status::ok ? 1U : 0U;
    }
  }

  void serve() {
    if (!rig_.can.running()) {
      ++begins_;
      static_cast<void>(rig_.can.begin(plain_config()));
    }
    static_cast<void>(rig_.can.poll());
    for (const Frame& frame : rig_.receive_all()) {
      check_received(frame);
    }
  }

  /// What the chip accepted, in its order, less what a lost chip took with it.
  void check_received(const Frame& frame) {
    ++received_;
    const std::size_t from = place_;
    while (place_ < rig_.accepted.size() && !(rig_.accepted[place_] == frame)) {
      ++place_;
    }
    ASSERT_LT(place_, rig_.accepted.size())
        << "handed out, and not accepted after the frame before it: " << frame << ", where " << from
        << " is expected";
    ++place_;
  }

  /// Each frame once, and none that nobody gave.
  void check_sent(const Frame& frame) {
    EXPECT_EQ(frame, checked(number_of(frame), frame.id)) << "a wrong frame was sent";
    EXPECT_TRUE(on_wire_.insert(number_of(frame)).second) << "sent twice: " << number_of(frame);
  }

  void calm_down() {
    rig_.bus.set_bit_errors(0, 0);
    reset_in_ = 0;
    unplug_in_ = 0;
    plug_in();
    for (int i = 0; i < 20'000 && !idle(); ++i) {
      serve();
      rig_.bus.run_for(microseconds(100));
    }
    EXPECT_TRUE(idle()) << "it hangs";
  }

  [[nodiscard]] bool idle() const {
    return rig_.can.running() && rig_.can.in_flight() + rig_.can.waiting() == 0 &&
           rig_.peer.waiting() == 0 && (rig_.chip.peek(0x2C) & 3) == 0;
  }

  std::mt19937& generator_;
  Rig<WithLine, 4, 8> rig_;
  std::size_t received_ = 0;
  std::size_t place_ = 0;  // in what the chip accepted
  std::set<std::uint32_t> on_wire_;
  std::uint32_t peer_number_ = 0;
  std::uint32_t submitted_ = 0;
  std::uint64_t begins_ = 0;
  std::uint64_t resets_ = 0;
  std::uint64_t unplugged_ = 0;
  std::uint32_t reset_in_ = 0;  // SPI steps; 0: not planned
  std::uint32_t unplug_in_ = 0;
  std::uint32_t plug_in_in_ = 0;
  bool plugged_ = true;
  sim::SimTime plug_in_at_{0};
};

template <bool WithLine>
void soak() {
  std::mt19937 generator = seeded_generator();
  Soak<WithLine> soak(generator);
  soak.run(std::chrono::seconds(soak_seconds()));
  soak.check();
}

TEST(FaultSoak, Polling) {
  soak<false>();
}
TEST(FaultSoak, WithAnInterruptLine) {
  soak<true>();
}

TEST(FaultSoak, AllIsWellOnceFlippedBitsOnSpiStop) {
  std::mt19937 generator = seeded_generator();
  Rig<false, 4, 4> rig;
  const sim::SimTime end = rig.bus.now() + std::chrono::seconds(soak_seconds()) / 10;
  int rounds = 0;
  while (rig.bus.now() < end) {
    ++rounds;
    rig.wire.set_bit_flips(1.0 / static_cast<double>(20 + up_to(generator, 5'000)),
                           static_cast<std::uint32_t>(generator()));
    for (int i = 0; i < 500; ++i) {
      if (!rig.can.running()) {
        static_cast<void>(rig.can.begin(plain_config()));
      }
      if (up_to(generator, 20) == 0) {
        rig.wire.lose_select_after(up_to(generator, 40));
      }
      if (rig.peer.waiting() < 4) {
        rig.peer.send(numbered(static_cast<std::uint32_t>(i), 8, from_peer));
      }
      static_cast<void>(rig.can.send(numbered(static_cast<std::uint32_t>(i), 8, from_driver)));
      static_cast<void>(rig.can.poll());
      rig.receive_all();
      rig.bus.run_for(microseconds(up_to(generator, 500)));
    }
    rig.wire.clear_faults();
    ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
    for (int i = 0; i < 3'000 && rig.peer.waiting() + rig.can.waiting() + rig.can.in_flight() > 0;
         ++i) {
      ASSERT_EQ(rig.can.poll(), Status::ok);
      rig.receive_all();
      rig.bus.run_for(microseconds(100));
    }
    rig.receive_all();
    ASSERT_EQ(rig.peer.waiting(), 0U);
    ASSERT_EQ(rig.can.waiting() + rig.can.in_flight(), 0);
    rig.peer_received.clear();
    rig.peer_sends({numbered(1), numbered(2)});
    ASSERT_EQ(rig.receive_all(), (std::vector{numbered(1), numbered(2)}));
    ASSERT_EQ(rig.can.send(numbered(3)), Status::ok);
    rig.bus.run_for(milliseconds(1));
    ASSERT_EQ(rig.peer_received, std::vector{numbered(3)});
    rig.accepted.clear();
    rig.can.traits().outcomes.clear();
  }
  EXPECT_GT(rounds, 1);
}

}  // namespace
}  // namespace roio::test
