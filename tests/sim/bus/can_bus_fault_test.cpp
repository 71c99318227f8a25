// Faults put on the simulated wire, and what becomes of the frames.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <roio/frame_length.hpp>
#include <roio/sim/can_bus.hpp>
#include <set>
#include <string>
#include <vector>

#include "station.hpp"

namespace roio::sim {
namespace {

using std::chrono::milliseconds;
using test::Station;
using test::text_of;
using Texts = std::vector<std::string>;

constexpr std::uint32_t rate = 500'000;
const SimTime bit = cycles(1, rate);
// docs/protocol.md "One frame, bit by bit": 84 bits to the end of the CRC, the acknowledge slot is
// bit 85, end-of-frame bits 87 to 93, the intermission 94 to 96.
const Frame first{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};
const Frame second{0x1000400A, FrameKind::extended, 1, {0x77}};
constexpr int acknowledge_slot = 85;
constexpr int last_but_one = 92;
constexpr int last = 93;
constexpr int frame_bits = 97;

// --- one flipped bit -----------------------------------------------------------------------------

enum class Victim : std::uint8_t { everybody, sender, receiver };

/// A sender and three receivers, the first of which may be the victim; one bit of the first of two
/// frames is flipped.
struct FlippedBit {
  FlippedBit(int at, Victim victim) {
    bus.run_for(milliseconds(1));
    sender.node.send(first);
    sender.node.send(second);
    bus.after(bit * at, [this, victim] {
      bus.flip_next_bit(victim == Victim::everybody ? nullptr
                        : victim == Victim::sender  ? &sender.node.controller()
                                                    : &receiver.node.controller());
    });
    bus.run_for(milliseconds(3));
  }
  CanBus bus;
  Station sender{bus};
  Station receiver{bus};
  Station other{bus};
  Station another{bus};
};

const Texts once{text_of(first), text_of(second)};
const Texts twice{text_of(first), text_of(first), text_of(second)};

TEST(FlippedBit, ForEverybody) {
  for (int at = 0; at < frame_bits; ++at) {
    FlippedBit test(at, Victim::everybody);
    // A receiver has the frame with the last bit of end-of-frame but one, its sender only with the
    // last. CAN knows no way around that.
    const Texts& expected = at == last ? twice : once;
    EXPECT_EQ(test.receiver.received, expected) << at;
    EXPECT_EQ(test.other.received, expected) << at;
    EXPECT_EQ(test.sender.sent, once) << at;
    EXPECT_EQ(test.bus.statistics().flipped_bits, 1U) << at;
    // A recessive bit of the identifier that turns dominant is taken for a stronger frame.
    const BusStatistics statistics = test.bus.statistics();
    EXPECT_EQ(statistics.transmit_errors + statistics.arbitrations_lost, at <= last ? 1U : 0U)
        << at;
  }
}

TEST(FlippedBit, ForTheSender) {
  for (int at = 0; at < frame_bits; ++at) {
    FlippedBit test(at, Victim::sender);
    const Texts& expected = at == last_but_one || at == last ? twice : once;
    EXPECT_EQ(test.receiver.received, expected) << at;
    EXPECT_EQ(test.other.received, expected) << at;
    EXPECT_EQ(test.sender.sent, once) << at;
  }
}

TEST(FlippedBit, ForOneReceiver) {
  for (int at = 0; at < frame_bits; ++at) {
    FlippedBit test(at, Victim::receiver);
    // What it refuses for the last bit but one, the others have already.
    const Texts& expected = at == last_but_one ? twice : once;
    EXPECT_EQ(test.receiver.received, once) << at;
    EXPECT_EQ(test.other.received, expected) << at;
    EXPECT_EQ(test.another.received, expected) << at;
    EXPECT_EQ(test.sender.sent, once) << at;
    EXPECT_LE(test.bus.statistics().transmit_errors, 1U) << at;
  }
}

TEST(FlippedBit, OfTheAcknowledgementIsNoLostFrame) {
  FlippedBit test(acknowledge_slot, Victim::sender);
  EXPECT_EQ(test.bus.statistics().transmit_errors, 1U);
  EXPECT_EQ(test.sender.transmit_errors(), 8U - 2U) << "8 for the error, 1 less for each success";
}

TEST(FlippedBit, CountsMoreForTheReceiverThatSawItAlone) {
  FlippedBit test(50, Victim::receiver);
  EXPECT_EQ(test.receiver.receive_errors(), 1U + 8U - 2U) << "its flag was the first";
  EXPECT_EQ(test.other.receive_errors(), 0U) << "1, and two frames since";
}

TEST(FlippedBit, HitsTheNodeMeantAmongNodesOfSeveralRates) {
  CanBus bus;
  Station stranger(bus, 250'000, Controller::Mode::listen_only);
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  sender.node.send(first);
  bus.after(bit * 50, [&] { bus.flip_next_bit(&receiver.node.controller()); });
  bus.run_for(milliseconds(1));
  EXPECT_EQ(receiver.node.receive_errors_seen(), 1U);
  EXPECT_EQ(bus.statistics().flipped_bits, 1U);
}

// --- bit errors at a rate ------------------------------------------------------------------------

/// Three senders, each with a numbered sequence, and a listener that only receives.
struct Noise {
  static constexpr std::uint32_t frames_each = 400;

  Noise(double probability, std::uint32_t seed) {
    bus.run_for(milliseconds(1));
    bus.on_frame([this](const Frame&, const Controller&) {
      for (Station& station : stations) {
        always_active = always_active && station.confinement() == Confinement::active;
      }
    });
    bus.set_bit_errors(probability, seed);
    for (std::uint32_t number = 0; number < frames_each; ++number) {
      for (std::size_t sender = 0; sender < 3; ++sender) {
        stations[sender].node.send(frame(sender, number));
      }
    }
    bus.run_for(std::chrono::seconds(1));
  }

  static Frame frame(std::size_t sender, std::uint32_t number) {
    return {static_cast<std::uint32_t>(0x10000000 + sender),
            FrameKind::extended,
            4,
            {static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>(number),
             static_cast<std::uint8_t>(sender), 0xFF}};
  }

  /// What one station has of one sender; duplicates that follow one another are taken out and
  /// counted.
  Texts distinct(const Station& station, std::size_t sender) {
    const std::string id = text_of(frame(sender, 0)).substr(0, 8);
    Texts result;
    for (const std::string& text : station.received) {
      if (text.substr(0, 8) != id) {
        continue;
      }
      if (!result.empty() && result.back() == text) {
        ++duplicates;
      } else {
        result.push_back(text);
      }
    }
    return result;
  }

  CanBus bus;
  std::array<Station, 4> stations{Station(bus), Station(bus), Station(bus), Station(bus)};
  bool always_active = true;
  std::uint64_t duplicates = 0;
};

TEST(BitErrors, LoseNothingAndChangeNothingAmongActiveNodes) {
  std::uint64_t errors = 0;
  std::uint64_t duplicates = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    Noise noise(1.0 / 5000, seed);
    ASSERT_TRUE(noise.always_active) << seed;
    for (std::size_t sender = 0; sender < 3; ++sender) {
      Texts sent;
      for (std::uint32_t number = 0; number < Noise::frames_each; ++number) {
        sent.push_back(text_of(Noise::frame(sender, number)));
      }
      EXPECT_EQ(noise.stations[sender].sent, sent) << seed;
      for (std::size_t receiver = 0; receiver < 4; ++receiver) {
        if (receiver != sender) {
          EXPECT_EQ(noise.distinct(noise.stations[receiver], sender), sent) << seed;
        }
      }
    }
    errors += noise.bus.statistics().transmit_errors;
    duplicates += noise.duplicates;
    EXPECT_GT(noise.bus.statistics().flipped_bits, 10U) << seed;
  }
  // Two of about a hundred bits make a duplicate, at up to three receivers.
  EXPECT_GT(errors, 100U);
  EXPECT_GT(duplicates, 0U);
  EXPECT_LT(duplicates, errors / 5);
}

TEST(BitErrors, ComeAtTheRateAskedForAndTheSameForASeed) {
  const Noise a(1.0 / 1000, 7);
  const Noise b(1.0 / 1000, 7);
  const Noise c(1.0 / 1000, 8);
  EXPECT_EQ(a.bus.statistics().flipped_bits, b.bus.statistics().flipped_bits);
  EXPECT_EQ(a.bus.statistics().busy, b.bus.statistics().busy);
  EXPECT_EQ(a.stations[3].received, b.stations[3].received);
  EXPECT_NE(a.bus.statistics().busy, c.bus.statistics().busy);
  const auto bits = static_cast<double>(a.bus.statistics().busy / bit);
  EXPECT_NEAR(static_cast<double>(a.bus.statistics().flipped_bits), bits / 1000, 0.3 * bits / 1000);
}

/// Notes each bit that it sees dominant.
class Sleeper final : public ControllerClient {
 public:
  explicit Sleeper(CanBus& bus) : bus_(bus) {
    bus.join(controller_, timing_of(rate));
    controller_.set_mode(Controller::Mode::asleep);
  }
  ~Sleeper() override { bus_.leave(controller_); }
  std::set<SimTime> dominant_bits;

 private:
  std::optional<Submission> next_submission() override { return std::nullopt; }
  void on_transmitted() override {}
  void on_arbitration_lost() override {}
  void on_transmit_error(BusError /*error*/) override {}
  void on_received(const Frame& /*frame*/) override {}
  void on_receive_error(BusError /*error*/) override {}
  void on_confinement_changed() override {}
  void on_bus_activity() override { dominant_bits.insert(bus_.now()); }

  CanBus& bus_;
  Controller controller_{*this};
};

TEST(BitErrors, HitEverybodyHalfOfTheTimeAndElseOneNode) {
  CanBus bus;
  Sleeper a(bus);
  Sleeper b(bus);
  bus.set_bit_errors(0.1, 1);
  bus.hold_dominant(true);
  constexpr int bits = 20'000;
  bus.run_for(bit * bits);
  std::set<SimTime> seen_by_any = a.dominant_bits;
  seen_by_any.insert(b.dominant_bits.begin(), b.dominant_bits.end());
  const auto flipped = static_cast<double>(bus.statistics().flipped_bits);
  EXPECT_NEAR(flipped, 0.1 * bits, 0.01 * bits);
  const auto for_both = static_cast<double>(bits - seen_by_any.size());
  const auto for_a = static_cast<double>(bits - a.dominant_bits.size()) - for_both;
  const auto for_b = static_cast<double>(bits - b.dominant_bits.size()) - for_both;
  EXPECT_EQ(for_a + for_b + for_both, flipped);
  EXPECT_NEAR(for_both, flipped / 2, flipped / 20);
  EXPECT_NEAR(for_a, flipped / 4, flipped / 20);
}

TEST(BitErrors, StopWhenToldTo) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.set_bit_errors(1, 1);
  sender.node.send(first);
  bus.run_for(milliseconds(20));
  EXPECT_EQ(receiver.received, Texts{});
  bus.set_bit_errors(0, 1);
  bus.run_for(milliseconds(200));
  EXPECT_EQ(receiver.received, Texts{text_of(first)});
}

// --- a wire held dominant ------------------------------------------------------------------------

TEST(DominantWire, MakesReceiversPassiveAndNobodyBusOffWhoseIdentifierHasARecessiveBit) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  bus.hold_dominant(true);
  sender.node.send(first);
  bus.run_for(milliseconds(100));
  EXPECT_EQ(sender.transmit_errors(), 0U) << "it lost arbitration";
  EXPECT_EQ(sender.receive_errors(), 255U);
  EXPECT_EQ(receiver.receive_errors(), 255U);
  EXPECT_EQ(receiver.confinement(), Confinement::passive);
  EXPECT_EQ(bus.statistics().frames, 0U);
  bus.hold_dominant(false);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(receiver.received, Texts{text_of(first)});
  EXPECT_EQ(receiver.receive_errors(), 127U);
}

TEST(DominantWire, InTheMiddleOfAFramePutsTheSenderBusOffAndItComesBack) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  sender.node.send(first);
  bus.run_for(bit * 50);
  bus.hold_dominant(true);
  // 6 bits of flag; then 8 more errors every 8 bits.
  bus.run_for(bit * (8 + 6 + 8 * 31));
  EXPECT_EQ(sender.confinement(), Confinement::bus_off);
  bus.run_for(milliseconds(10));
  EXPECT_EQ(sender.confinement(), Confinement::bus_off) << "as long as the wire is held";
  bus.hold_dominant(false);
  bus.run_for(bit * 128 * 11);
  EXPECT_EQ(sender.confinement(), Confinement::active);
  bus.run_for(bit * frame_bits);
  EXPECT_EQ(receiver.received, Texts{text_of(first)});
}

TEST(DominantWire, KeepsANewcomerFromTakingPart) {
  CanBus bus;
  bus.hold_dominant(true);
  Station node(bus);
  Station receiver(bus);
  node.node.send(first);
  bus.run_for(milliseconds(10));
  EXPECT_EQ(node.receive_errors() + node.transmit_errors(), 0U) << "it waits for 11 recessive bits";
  bus.hold_dominant(false);
  bus.run_for(bit * (11 + frame_bits));
  EXPECT_EQ(receiver.received, Texts{text_of(first)});
}

// --- a node that goes silent, and one that does not stop -----------------------------------------

TEST(CutTransmitter, GoesBusOffAndDisturbsNobody) {
  CanBus bus;
  Station cut(bus);
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  cut.node.controller().cut_transmitter(true);
  cut.node.send(first);
  bus.run_for(bit * 33);
  EXPECT_EQ(cut.confinement(), Confinement::passive);
  bus.run_for(milliseconds(2));
  EXPECT_EQ(cut.confinement(), Confinement::bus_off);
  sender.node.send(second);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(receiver.received, Texts{text_of(second)});
  EXPECT_EQ(sender.transmit_errors() + receiver.receive_errors(), 0U);

  cut.node.controller().cut_transmitter(false);
  bus.run_for(bit * 128 * 11 + milliseconds(1));
  EXPECT_EQ(receiver.received, (Texts{text_of(second), text_of(first)}));
}

TEST(CutTransmitter, StaysCutWhenTheNodeJoinsAgain) {
  CanBus bus;
  Station cut(bus);
  Station receiver(bus);
  cut.node.controller().cut_transmitter(true);
  bus.leave(cut.node.controller());
  bus.join(cut.node.controller(), timing_of(rate));
  cut.node.send(first);
  bus.run_for(milliseconds(10));
  EXPECT_EQ(receiver.received, Texts{});
}

TEST(CutTransmitter, TheOnlyReceiverCannotAcknowledge) {
  CanBus bus;
  Station cut(bus);
  Station sender(bus);
  bus.run_for(milliseconds(1));
  cut.node.controller().cut_transmitter(true);
  sender.node.send(first);
  bus.run_for(milliseconds(50));
  EXPECT_EQ(sender.sent, Texts{});
  EXPECT_EQ(sender.transmit_errors(), 128U);
}

TEST(Babbler, TakesTheBusAndWhenItStopsTheOthersGoOn) {
  CanBus bus;
  auto babbler = std::make_unique<Station>(bus);
  std::array<Station, 3> others{Station(bus), Station(bus), Station(bus)};
  bus.run_for(milliseconds(1));
  const Frame babble{0, FrameKind::standard, 0, {}};
  Station* const raw = babbler.get();
  babbler->node.on_sent([raw, babble](const Frame&) { raw->node.send(babble); });
  babbler->node.send(babble);
  for (std::size_t i = 0; i < others.size(); ++i) {
    others[i].node.send({static_cast<std::uint32_t>(1 + i), FrameKind::extended, 0, {}});
  }
  bus.run_for(milliseconds(100));
  const Texts heard = others[0].received;
  EXPECT_EQ(heard.size(), 100U * 500 / wire_bits(babble));
  EXPECT_EQ(Texts(heard.size(), text_of(babble)), heard);
  EXPECT_EQ(others[1].received, heard);
  EXPECT_EQ(others[2].received, heard);
  EXPECT_EQ(bus.statistics().transmit_errors, 0U);
  EXPECT_EQ(babbler->received, Texts{});
  babbler.reset();
  bus.run_for(milliseconds(1));
  EXPECT_EQ(others[0].sent, Texts{"00000001 DLC 0"});
  EXPECT_EQ(others[1].sent, Texts{"00000002 DLC 0"});
  EXPECT_EQ(others[2].sent, Texts{"00000003 DLC 0"});
}

// --- an error-passive node -----------------------------------------------------------------------

TEST(PassiveNode, GivesWayToAnActiveOneAfterItsFrame) {
  CanBus bus;
  Station passive(bus);
  bus.run_for(milliseconds(1));
  passive.node.send(first);
  bus.run_for(milliseconds(20));
  ASSERT_EQ(passive.confinement(), Confinement::passive);
  Station active(bus);
  Station receiver(bus);
  // Raise it well above 128, so that it stays passive after a success.
  for (int i = 0; i < 4; ++i) {
    while (!passive.node.controller().transmitting()) {
      bus.run_for(bit);
    }
    bus.run_for(bit * 10);
    bus.flip_next_bit(&passive.node.controller());
    bus.run_for(bit * 2);
  }
  ASSERT_GT(passive.transmit_errors(), 140U);
  bus.run_for(milliseconds(2));
  receiver.received.clear();
  ASSERT_EQ(passive.confinement(), Confinement::passive);
  // The passive node's identifier is stronger, yet it has to wait for 8 bits.
  for (int i = 0; i < 2; ++i) {
    passive.node.send({0x1, FrameKind::extended, 0, {}});
    active.node.send({0x2, FrameKind::extended, 0, {}});
  }
  bus.run_for(milliseconds(2));
  EXPECT_EQ(receiver.received,
            (Texts{"00000001 DLC 0", "00000002 DLC 0", "00000001 DLC 0", "00000002 DLC 0"}));
}

}  // namespace
}  // namespace roio::sim
