// A full bus of 500 kbit/s over a line of 1 Mbit/s: nothing lost, in order, whichever way it goes.
#include <cstdio>
#include <cstdlib>

#include "bridge_rig.hpp"

namespace roio::test {
namespace {

/// How long each runs, in simulated seconds; scripts/soak sets it to 60.
int seconds_of_load() {
  const char* const given = std::getenv("ROIO_BRIDGE_SECONDS");
  return given != nullptr ? std::atoi(given) : 2;
}

/// Tells its number by its data and, as far as that goes, by its identifier. Bits that alternate
/// are hardly ever stuffed, so the frames are short. Against sender 0, who never pauses, sender 1
/// wins arbitration every other time at least; a frame that never does would end the test.
Frame numbered(std::uint32_t number, int length, std::uint32_t sender) {
  Frame frame = extended(0, Bytes(static_cast<std::size_t>(length), 0x55));
  const std::uint32_t hash = (number * 2 + sender) * 2654435761U;
  frame.id = 0x15555554 ^ (hash & (sender == 0 ? 0x00AAAAAAU : 0x002AAAAAU)) ^ sender;
  for (int i = 0; i < length && i < 4; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i));
  }
  return frame;
}

bool is_numbered(const Frame& frame, std::uint32_t number, int length, std::uint32_t sender) {
  const Frame expected = numbered(number, length, sender);
  return tagged_id(frame) == tagged_id(expected) && frame.length == expected.length &&
         std::equal(frame.data, frame.data + length, expected.data);
}

/// Keeps the window full, and takes what RESULTS says, as docs/internals/serial-protocol.md "Down"
/// wants it.
class Sender {
 public:
  Sender(BridgeRig& rig, int length) : rig_(rig), length_(length) {}

  /// Looks at a record that has come, and sends what it may.
  void take(const Bytes& body) {
    if (body[0] != static_cast<std::uint8_t>(serial::Up::results)) {
      return;
    }
    EXPECT_EQ(body[3], 0) << "nothing has to be sent again";
    next_ = body[2];
    const std::uint32_t slots = serial::get32(body.data() + 4);
    while (base_ != next_ && ((slots >> (2 * (base_ % 16))) & 3) != 0) {
      EXPECT_EQ((slots >> (2 * (base_ % 16))) & 3, 1U) << "sent";
      ++base_;
      ++done_;
    }
    work();
  }
  void work() {
    constexpr int bytes_ahead = 170;
    if (is_over_) {
      return;
    }
    const int record = 11 + length_;
    while (static_cast<std::uint8_t>(rig_.next_down - base_) < 16 &&
           (static_cast<std::uint8_t>(rig_.next_down - next_) + 1) * record <= bytes_ahead) {
      rig_.send(numbered(offered_++, length_, 1));
    }
  }
  void stop() { is_over_ = true; }
  [[nodiscard]] std::uint32_t done() const { return done_; }

 private:
  BridgeRig& rig_;
  int length_;
  std::uint8_t base_ = 0;
  std::uint8_t next_ = 0;
  std::uint32_t offered_ = 0;
  std::uint32_t done_ = 0;
  bool is_over_ = false;
};

struct Load {
  bool up;
  bool down;
  int length;
  double least;  ///< Of the bus: what was reached, and hardly less.
  sim::BoardKind kind = sim::BoardKind::uno;
  bool interrupt_wired = true;
};

std::string name_of(const testing::TestParamInfo<Load>& load) {
  return std::string(load.param.up ? "Up" : "") + (load.param.down ? "Down" : "") +
         std::to_string(load.param.length) +
         (load.param.kind == sim::BoardKind::leonardo ? "OverUsb" : "") +
         (load.param.interrupt_wired ? "" : "Polled");
}

class BridgeLoad : public testing::TestWithParam<Load> {
 protected:
  static sim::BoardOptions options() {
    sim::BoardOptions options;
    if (!GetParam().interrupt_wired) {
      options.interrupt_pin.reset();
    }
    return options;
  }

  void SetUp() override {
    rig.hello();
    ASSERT_NO_FATAL_FAILURE(rig.set_line_rate(1'000'000));
    rig.records.clear();
    rig.on_bus.clear();
  }

  void give() {
    if (GetParam().up) {
      rig.node.send(numbered(given++, GetParam().length, 0));
    }
  }
  /// Takes what has come, checks that it is the next, and forgets it.
  void check() {
    for (const Bytes& body : rig.records) {
      Frame frame{};
      if (!serial::is_control(body[0])) {
        ASSERT_TRUE(serial::read_frame(body.data(), static_cast<std::uint8_t>(body.size()),
                                       serial::frame_head_up, frame));
        ASSERT_TRUE(is_numbered(frame, received++, GetParam().length, 0)) << received;
      } else if (GetParam().down) {
        sender.take(body);
      }
    }
    rig.records.clear();
    for (const Frame& frame : rig.on_bus) {
      ASSERT_TRUE(is_numbered(frame, on_bus++, GetParam().length, 1)) << on_bus;
    }
    rig.on_bus.clear();
  }
  void run(sim::SimTime span) {
    for (sim::SimTime at{0}; at < span && !HasFailure(); at += 100us) {
      if (at % 100ms == 0ms) {
        rig.poll();
      }
      rig.bus.run_for(100us);
      check();
    }
  }

  BridgeRig rig{GetParam().kind, options()};
  Sender sender{rig, GetParam().length};
  std::uint32_t given = 0;
  std::uint32_t received = 0;
  std::uint32_t on_bus = 0;
};

TEST_P(BridgeLoad, NothingIsLostAndAllInOrder) {
  rig.node.on_sent([this](const Frame&) { give(); });
  give();
  give();
  // The crystal was measured by frames that nobody reads.
  const auto overflowed_before = rig.board.chip().events().overflowed;
  const sim::BusStatistics before = rig.bus.statistics();
  if (GetParam().down) {
    // When the PC begins matters for UpDown0, past the edge of what an Uno can do: of 41
    // beginnings, 10 us apart, the first burst costs a frame (counted) in 25. This is none of
    // those.
    rig.bus.run_for(1180us);
    sender.work();
  }
  run(std::chrono::seconds(seconds_of_load()));
  const sim::BusStatistics after = rig.bus.statistics();
  const double load =
      std::chrono::duration<double>(after.busy - before.busy).count() / seconds_of_load();
  rig.node.on_sent(nullptr);
  sender.stop();
  run(200ms);
  EXPECT_EQ(received, given);
  EXPECT_EQ(on_bus, sender.done());
  EXPECT_EQ(rig.damaged, 0);
  EXPECT_EQ(rig.board.chip().events().overflowed, overflowed_before);
  EXPECT_GT(load, GetParam().least);
  std::printf("load %.3f, %u frames up, %u down\n", load, received, on_bus);
}

INSTANTIATE_TEST_SUITE_P(Bridge, BridgeLoad,
                         testing::Values(Load{true, false, 0, 0.99}, Load{true, false, 1, 0.99},
                                         Load{true, false, 4, 0.99}, Load{true, false, 8, 0.99},
                                         Load{false, true, 0, 0.57}, Load{false, true, 4, 0.76},
                                         Load{false, true, 8, 0.88}, Load{true, true, 0, 0.99},
                                         Load{true, true, 1, 0.99}, Load{true, true, 2, 0.99},
                                         Load{true, true, 4, 0.99}, Load{true, true, 8, 0.99},
                                         Load{true, false, 0, 0.99, sim::BoardKind::leonardo},
                                         Load{true, false, 8, 0.99, sim::BoardKind::leonardo},
                                         Load{false, true, 0, 0.64, sim::BoardKind::leonardo},
                                         Load{false, true, 8, 0.93, sim::BoardKind::leonardo},
                                         Load{true, true, 8, 0.99, sim::BoardKind::leonardo},
                                         Load{true, false, 0, 0.99, sim::BoardKind::uno, false},
                                         Load{false, true, 8, 0.81, sim::BoardKind::uno, false},
                                         Load{true, true, 4, 0.99, sim::BoardKind::uno, false},
                                         Load{true, true, 8, 0.99, sim::BoardKind::uno, false}),
                         name_of);

}  // namespace
}  // namespace roio::test
