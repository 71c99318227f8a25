// The bus: time, joining and leaving, arbitration.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <roio/frame_length.hpp>
#include <roio/sim/can_bus.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "can_bus_rig.hpp"
#include "vectors.hpp"

namespace roio::sim {
namespace {

using std::chrono::milliseconds;

// --- time ----------------------------------------------------------------------------------------

TEST(CanBus, AFrameIsThereWithItsLastBitAndItsSenderKnows) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  SimTime received{0};
  SimTime sent{0};
  receiver.node.on_receive([&](const Frame&) { received = bus.now(); });
  sender.node.on_sent([&](const Frame&) { sent = bus.now(); });
  const SimTime start = bus.now();
  sender.node.send(document_frame);
  bus.run_for(milliseconds(1));
  // 97 bits, the last three of which are intermission; sampled at 80 %.
  EXPECT_EQ(sent - start, bit * 93 + bit * 4 / 5);
  EXPECT_EQ(received - start, sent - start - bit) << "one bit earlier";
}

TEST(CanBus, FramesBackToBackTakeExactlyTheirBits) {
  for (const test::Vector& vector : test::read_vectors(ROIO_PROTOCOL_DOCUMENT)) {
    Frame frame{vector.id, FrameKind::extended, vector.message.length, {}};
    std::copy_n(vector.message.data, frame.length, frame.data);
    CanBus bus;
    Station sender(bus);
    Station receiver(bus);
    bus.run_for(milliseconds(1));
    send_without_end(sender, frame);
    const std::uint64_t frames = 1000;
    // To the end of the intermission after the last of them, and no more.
    bus.run_for(bit * vector.bits * frames);
    EXPECT_EQ(bus.statistics().frames, frames) << vector;
    EXPECT_EQ(receiver.received.size(), frames) << vector;
    EXPECT_FALSE(sender.node.controller().busy()) << vector;
    bus.run_for(bit);
    EXPECT_TRUE(sender.node.controller().busy()) << vector;
  }
}

TEST(CanBus, AnIdleBusStartsABitWhenAFrameComes) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1) + SimTime(1'234'567));  // no whole number of bits
  const SimTime start = bus.now();
  SimTime sent{0};
  sender.node.on_sent([&](const Frame&) { sent = bus.now(); });
  sender.node.send(document_frame);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(sent - start, bit * 93 + bit * 4 / 5);
}

TEST(CanBus, TheIntermissionIsNotCutShort) {
  CanBus bus;
  Station sender(bus);
  Station receiver(bus);
  bus.run_for(milliseconds(1));
  std::vector<SimTime> sent;
  sender.node.on_sent([&](const Frame&) { sent.push_back(bus.now()); });
  sender.node.send(document_frame);
  // The last bit of the intermission is sampled already, but not over.
  bus.after(bit * 97 - bit / 10, [&] { sender.node.send(document_frame); });
  bus.run_for(milliseconds(1));
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[1] - sent[0], bit * 97);
}

TEST(CanBus, TimePassesThoughNobodyIsThere) {
  CanBus bus;
  bus.run_until(SimTime(1000));
  EXPECT_EQ(bus.now(), SimTime(1000));
  bus.run_until(SimTime(10));
  EXPECT_EQ(bus.now(), SimTime(1000)) << "never back";
}

TEST(CanBus, ActionsComeAtTheirTimeInTheOrderAskedFor) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  send_without_end(a, document_frame);
  std::vector<std::string> order;
  const auto note = [&](const std::string& what) {
    order.push_back(what + " " + std::to_string(bus.now().count()));
  };
  bus.at(SimTime(200), [&] { note("third"); });
  bus.at(SimTime(100), [&] { note("first"); });
  bus.at(SimTime(200), [&] { note("fourth"); });
  bus.at(SimTime(100), [&] {
    note("second");
    bus.at(SimTime(5), [&] { note("gone by"); });
    bus.after(SimTime(300), [&] { note("fifth"); });
  });
  bus.at(SimTime(100), [&] { note("between"); });
  bus.at(SimTime(1001), [&] { note("never"); });
  bus.run_until(SimTime(1000));
  EXPECT_EQ(order, (Texts{"first 100", "second 100", "between 100", "gone by 100", "third 200",
                          "fourth 200", "fifth 400"}));
  EXPECT_EQ(bus.now(), SimTime(1000));
}

TEST(CanBus, AnActionAtTheEndOfARunIsInIt) {
  CanBus bus;
  int calls = 0;
  bus.at(SimTime(1000), [&] { ++calls; });
  bus.run_until(SimTime(999));
  EXPECT_EQ(calls, 0);
  bus.run_until(SimTime(1000));
  EXPECT_EQ(calls, 1);
}

TEST(CanBus, AnActionComesBeforeTheBitThatBeginsThen) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  bus.run_for(milliseconds(1));
  a.node.send(extended(0x10000002));
  const int bits = wire_bits(extended(0x10000002));
  // Both at the very end of the intermission: they start together, and the lower identifier wins.
  a.node.send(extended(0x10000002));
  bus.after(bit * bits, [&] { b.node.send(extended(0x10000001)); });
  bus.run_for(milliseconds(1));
  EXPECT_EQ(bus.statistics().arbitrations_lost, 1U);
  EXPECT_EQ(a.received, Texts{text_of(extended(0x10000001))});
}

TEST(CanBus, AnActionMayRunTheBus) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  std::vector<int> order;
  bus.at(SimTime(0) + milliseconds(1), [&] {
    a.node.send(document_frame);
    bus.run_for(milliseconds(1));
    order.push_back(static_cast<int>(b.received.size()));
  });
  bus.at(SimTime(0) + milliseconds(3), [&] { order.push_back(2); });
  bus.run_until(milliseconds(4));
  EXPECT_EQ(order, (std::vector<int>{1, 2}));
  EXPECT_EQ(bus.now(), SimTime(milliseconds(4)));
}

TEST(CanBus, ACallbackOfANodeMayNotRunTheBus) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  int refused = 0;
  b.node.on_receive([&](const Frame&) {
    EXPECT_THROW(bus.run_for(milliseconds(1)), std::logic_error);
    ++refused;
  });
  a.node.send(document_frame);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(refused, 1);
}

// --- joining and leaving -------------------------------------------------------------------------

TEST(CanBus, ANewcomerWaitsForElevenRecessiveBitsAndMissesTheFrameUnderWay) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  bus.run_for(milliseconds(1));
  a.node.send(document_frame);
  bus.run_for(bit * 40);
  Station newcomer(bus);
  newcomer.node.send(extended(0x00000001));
  bus.run_for(milliseconds(1));
  EXPECT_EQ(newcomer.received, Texts{});
  EXPECT_EQ(a.received, Texts{text_of(extended(0x00000001))});
  EXPECT_EQ(bus.statistics().transmit_errors, 0U);
}

TEST(CanBus, AStationMayLeaveInTheMiddleOfItsFrame) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  auto leaver = std::make_unique<Station>(bus);
  bus.run_for(milliseconds(1));
  leaver->node.send(document_frame);
  bus.run_for(bit * 40);
  leaver.reset();
  bus.run_for(milliseconds(1));
  a.node.send(document_frame);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(b.received, Texts{text_of(document_frame)});
}

TEST(CanBus, StationsMayLeaveAndJoinInACallback) {
  CanBus bus;
  Station sender(bus);
  auto leaver = std::make_unique<Station>(bus);
  Station middle(bus);
  Station other(bus);
  Station last(bus);
  std::vector<std::unique_ptr<Station>> newcomers;
  middle.node.on_receive([&](const Frame&) {
    leaver.reset();
    while (newcomers.size() < 50) {
      newcomers.push_back(std::make_unique<Station>(bus));
    }
  });
  sender.node.send(document_frame);
  bus.run_for(milliseconds(1));
  ASSERT_EQ(newcomers.size(), 50U);
  EXPECT_EQ(other.received, Texts{text_of(document_frame)});
  EXPECT_EQ(last.received, Texts{text_of(document_frame)});
  middle.node.on_receive(nullptr);
  sender.node.send(document_frame);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(last.received.size(), 2U);
  EXPECT_EQ(newcomers.back()->received, Texts{text_of(document_frame)});
  EXPECT_EQ(bus.statistics().transmit_errors, 0U);
}

TEST(CanBus, AControllerMayLeaveAndJoinAgainInItsOwnCallback) {
  CanBus bus;
  Station sender(bus);
  Station mover(bus);
  Station other(bus);
  mover.node.on_receive([&](const Frame& frame) {
    bus.leave(mover.node.controller());
    bus.join(mover.node.controller(), timing_of(rate));
    mover.received.push_back(text_of(frame));
  });
  for (int i = 0; i < 3; ++i) {
    sender.node.send(document_frame);
  }
  bus.run_for(milliseconds(2));
  EXPECT_EQ(mover.received.size(), 3U);
  EXPECT_EQ(other.received.size(), 3U);
  EXPECT_EQ(bus.statistics().transmit_errors, 0U);
}

// --- arbitration ---------------------------------------------------------------------------------

TEST(CanBus, TheLowerArbitrationFieldWins) {
  const Frame by_strength[] = {
      {0x000, FrameKind::standard, 1, {1}},
      {0x100, FrameKind::standard, 1, {1}},
      {0x100, FrameKind::standard_remote, 1, {}},
      {0x100 << 18, FrameKind::extended, 1, {1}},
      {0x100 << 18, FrameKind::extended_remote, 1, {}},
      {(0x100 << 18) | 1, FrameKind::extended, 1, {1}},
      {(0x100 << 18) | 0x20000, FrameKind::extended, 1, {1}},
      {0x101, FrameKind::standard, 1, {1}},
      {0x1FFFFFFF, FrameKind::extended, 1, {1}},
      {0x1FFFFFFF, FrameKind::extended_remote, 1, {}},
  };
  for (const Frame& strong : by_strength) {
    for (const Frame* weak = &strong + 1; weak != std::end(by_strength); ++weak) {
      CanBus bus;
      Station a(bus);
      Station b(bus);
      Station listener(bus);
      bus.run_for(milliseconds(1));
      a.node.send(*weak);
      b.node.send(strong);
      const SimTime start = bus.now();
      bus.run_for(bit * (wire_bits(strong) + wire_bits(*weak)));
      const std::string pair = text_of(strong) + " against " + text_of(*weak);
      EXPECT_EQ(listener.received, (Texts{text_of(strong), text_of(*weak)})) << pair;
      EXPECT_EQ(a.received, Texts{text_of(strong)}) << pair;
      EXPECT_EQ(bus.statistics().busy, bus.now() - start) << "the loser retries at once: " << pair;
      EXPECT_EQ(bus.statistics().transmit_errors, 0U) << pair;
      EXPECT_EQ(bus.statistics().arbitrations_lost, 1U) << pair;
    }
  }
}

TEST(CanBus, TwentyNodesContendInStrictOrder) {
  std::mt19937 generator = test::seeded_generator();
  for (int round = 0; round < 20; ++round) {
    CanBus bus;
    Station listener(bus);
    std::vector<std::unique_ptr<Station>> stations;
    std::vector<Frame> frames;
    while (frames.size() < 20) {
      const Frame frame = test::random_frame(generator);
      const bool taken = std::any_of(frames.begin(), frames.end(), [&](const Frame& other) {
        return arbitration_key(other) == arbitration_key(frame);
      });
      if (!taken) {
        frames.push_back(frame);
        stations.push_back(std::make_unique<Station>(bus));
      }
    }
    bus.run_for(milliseconds(1));
    for (std::size_t i = 0; i < frames.size(); ++i) {
      stations[i]->node.send(frames[i]);
    }
    std::sort(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) {
      return arbitration_key(a) < arbitration_key(b);
    });
    bus.run_for(milliseconds(20));
    ASSERT_EQ(listener.received, text_of(frames));
    ASSERT_EQ(bus.statistics().transmit_errors, 0U);
  }
}

TEST(CanBus, TheSameFrameFromTwoIsOneOnTheWireAndSentByBoth) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  Station listener(bus);
  bus.run_for(milliseconds(1));
  a.node.send(document_frame);
  b.node.send(document_frame);
  bus.run_for(milliseconds(2));
  const Texts once{text_of(document_frame)};
  EXPECT_EQ(listener.received, once);
  EXPECT_EQ(a.sent, once);
  EXPECT_EQ(b.sent, once);
  EXPECT_EQ(a.received, Texts{});
  EXPECT_EQ(bus.statistics().busy, bit * 97);
  EXPECT_EQ(bus.statistics().transmit_errors, 0U);
}

TEST(CanBus, TwoThatTransmitAloneMustNotTakeEachOthersFrameForAnAcknowledgement) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  bus.run_for(milliseconds(1));
  a.node.send(document_frame);
  b.node.send(document_frame);
  bus.run_for(milliseconds(1));
  EXPECT_EQ(a.sent, Texts{});
  EXPECT_GT(bus.statistics().transmit_errors, 1U);
}

TEST(CanBus, TheSameIdentifierWithOtherDataIsABitErrorTimeAndAgain) {
  CanBus bus;
  Station a(bus);
  Station b(bus);
  Station listener(bus);
  bus.run_for(milliseconds(1));
  a.node.send(extended(0x10000001, 0x00));
  b.node.send(extended(0x10000001, 0x80));
  // Up to the first bit of data, in which b's is recessive and a's dominant.
  bus.run_for(bit * 60);
  EXPECT_EQ(b.transmit_errors(), 8U) << "who sent the recessive bit";
  EXPECT_EQ(a.transmit_errors(), 8U) << "whose frame the flag destroyed";
  EXPECT_EQ(listener.receive_errors(), 1U);
  bus.run_for(bit * 60 * 7);
  EXPECT_EQ(listener.received, Texts{}) << "they retry together, and fail together";
  bus.run_for(milliseconds(10));
  // Error-passive at the same moment, both suspend; then whoever sends the dominant bit does not
  // see the other's passive flag, and is through.
  Texts expected{text_of(extended(0x10000001, 0x00)), text_of(extended(0x10000001, 0x80))};
  EXPECT_EQ(listener.received, expected);
  EXPECT_EQ(a.sent.size() + b.sent.size(), 2U);
  EXPECT_GE(bus.statistics().transmit_errors, 32U);
}

}  // namespace
}  // namespace roio::sim
