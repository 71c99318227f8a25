// What the simulated network does beyond the contract: a wire with faults, and an end before its
// participants'.
#include <algorithm>
#include <functional>
#include <roio/error.hpp>
#include <roio/sim/network.hpp>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "contract.hpp"
#include "socketcan/errors.hpp"

namespace roio::test {
namespace {

using std::chrono::milliseconds;

/// Within the guard.
bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + guard;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(milliseconds(1));
  }
  return true;
}

void hold_dominant(sim::Network& network, bool hold) {
  network.in_simulation([hold](sim::CanBus& bus) { bus.hold_dominant(hold); });
}

/// What a participant that asked for error reports has waiting.
std::vector<Frame> waiting(Bus& bus) {
  std::vector<Frame> frames;
  Received received{};
  while (bus.receive(received, no_wait) == Result::ok) {
    frames.push_back(received.frame);
  }
  return frames;
}

TEST(SimulatedNetwork, DeliversEveryFrameInOrderOverANoisyWire) {
  constexpr std::uint32_t count = 300;
  sim::Network network;
  const auto sender = network.join({.error_frames = true});
  const auto receiver = network.join();
  // One bit in a thousand: every tenth frame or so is hit.
  network.in_simulation([](sim::CanBus& bus) { bus.set_bit_errors(0.001, 7); });
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    frames.push_back(numbered(i));
  }
  auto sending = in_thread([&] { return sender->send(frames, guard).result; });
  std::vector<Frame> seen;
  while (!HasFailure() && (seen.empty() || !(seen.back() == frames.back()))) {
    seen.push_back(receive_exactly(*receiver, 1).at(0).frame);
  }
  // A frame whose last bit was spoiled for its sender alone is sent again, by CAN's own rules.
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  EXPECT_EQ(seen, frames);
  EXPECT_EQ(result_of(sending), Result::ok);
  network.in_simulation([](sim::CanBus& bus) {
    bus.set_bit_errors(0, 0);
    EXPECT_GT(bus.statistics().transmit_errors, 0U);
  });
  ASSERT_TRUE(eventually([&] { return sender->statistics().error_frames > 0; }));
  const std::vector<Frame> reports = waiting(*sender);
  ASSERT_FALSE(reports.empty());
  EXPECT_TRUE(std::all_of(reports.begin(), reports.end(), [](const Frame& frame) {
    return frame.kind == FrameKind::error && is_valid(frame);
  }));
  for (const Frame& frame : waiting(*receiver)) {
    EXPECT_EQ(frame, frames.back()) << "the receiver did not ask for reports";
  }
  EXPECT_EQ(sender->statistics().received, 0U) << "a report is not a frame";
}

TEST(SimulatedNetwork, TellsOfBusOffAndComesBack) {
  sim::Network network;
  const auto sender = network.join({.error_frames = true});
  const auto receiver = network.join();
  EXPECT_EQ(sender->state(), BusState::active);
  // In the middle of the second frame: what begins between two is not of the sender's making.
  network.in_simulation([](sim::CanBus& bus) {
    bus.on_frame([&bus, held = false](const Frame&, const sim::Controller&) mutable {
      if (!std::exchange(held, true)) {
        bus.after(std::chrono::microseconds(50), [&bus] { bus.hold_dominant(true); });
      }
    });
  });
  send_all(*sender, std::vector(50, numbered(0)));
  receive_exactly(*receiver, 1);
  ASSERT_TRUE(eventually([&] { return sender->state() == BusState::bus_off; }))
      << to_string(sender->state());
  EXPECT_EQ(sender->statistics().bus_offs, 1U);
  hold_dominant(network, false);
  receive_exactly(*receiver, 49);
  ASSERT_TRUE(eventually([&] { return sender->state() == BusState::active; }))
      << to_string(sender->state());
  EXPECT_EQ(sender->statistics().bus_offs, 1U);

  BusState decoded = BusState::active;
  bool entered_bus_off = false;
  for (const Frame& report : waiting(*sender)) {
    const auto meaning = socketcan::decode_error_report(report, decoded);
    decoded = meaning.state;
    entered_bus_off = entered_bus_off || meaning.entered_bus_off;
    EXPECT_FALSE(meaning.overrun);
  }
  EXPECT_TRUE(entered_bus_off);
  EXPECT_EQ(decoded, BusState::active) << "the reports tell what state() does";
}

TEST(SimulatedNetwork, LeavesALoneSenderItsFramesWithoutAWitness) {
  sim::Network network({.witness = false});
  const auto sender = network.join();
  send_all(*sender, {numbered(1), numbered(2), numbered(3), numbered(4)});
  ASSERT_TRUE(eventually([&] { return sender->state() == BusState::passive; }))
      << to_string(sender->state());
  sender->close();
  EXPECT_EQ(sender->statistics().sent, 4U);
  EXPECT_EQ(sender->statistics().unsent, 4U);
}

TEST(SimulatedNetwork, AcknowledgesALoneSender) {
  sim::Network network;
  const auto sender = network.join();
  send_all(*sender, {numbered(1), numbered(2), numbered(3), numbered(4)});
  sender->close();
  EXPECT_EQ(sender->statistics().unsent, 0U);
  EXPECT_EQ(sender->state(), BusState::active);
}

TEST(SimulatedNetwork, TellsAtCloseWhichFramesTheBusHadNoTimeFor) {
  sim::Network network({.bitrate_bps = 5'000});  // fifty frames a second at the most
  const auto receiver = network.join();
  const auto sender = network.join();
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 120; ++i) {
    frames.push_back(numbered(i));
  }
  send_all(*sender, frames);
  sender->close();
  const std::uint64_t unsent = sender->statistics().unsent;
  EXPECT_GT(unsent, 0U);
  ASSERT_LT(unsent, frames.size());
  frames.resize(frames.size() - unsent);
  EXPECT_EQ(frames_of(receive_exactly(*receiver, frames.size())), frames);
  expect_silence(*receiver);
  EXPECT_EQ(receiver->statistics().error_frames, 0U) << "no frame was cut short";
}

TEST(SimulatedNetwork, HasRoomForUrgentFramesWhereNormalOnesWait) {
  sim::Network network;
  const auto sender = network.join();
  const auto receiver = network.join({.send_only = true});
  EXPECT_EQ(sender->send(std::vector(1'000, numbered(0)), no_wait).result, Result::timeout);
  EXPECT_EQ(sender->send(numbered(1, 0x0000400A), no_wait), Result::ok);
}

TEST(SimulatedNetwork, IsAbsentForThoseWhoOutliveIt) {
  auto network = std::make_unique<sim::Network>();
  const auto sender = network->join();
  const auto receiver = network->join();
  send_all(*sender, {numbered(1)});
  ASSERT_TRUE(is_readable(*receiver, guard));
  network.reset();
  for (Bus* const bus : {sender.get(), receiver.get()}) {
    EXPECT_EQ(bus->state(), BusState::absent);
    EXPECT_EQ(bus->statistics().outages, 1U);
    EXPECT_EQ(bus->send(numbered(2), milliseconds(1)), Result::timeout);
  }
  EXPECT_EQ(frames_of(receive_exactly(*receiver, 1)), std::vector{numbered(1)});
  receiver->close();
  Received received{};
  EXPECT_EQ(receiver->receive(received, forever), Result::closed);
}

TEST(SimulatedNetwork, TakesAFramesTimeHoweverLongItWasIdle) {
  constexpr std::chrono::microseconds at_least{
      178};  // 32 bits of data and 57 around, at 500 kbit/s
  sim::Network network;
  const auto sender = network.join();
  const auto receiver = network.join();
  for (const milliseconds idle : {milliseconds(0), milliseconds(1), milliseconds(10)}) {
    std::this_thread::sleep_for(idle);
    const auto before = std::chrono::steady_clock::now();
    send_all(*sender, {numbered(1)});
    receive_exactly(*receiver, 1);
    EXPECT_GE(std::chrono::steady_clock::now() - before, at_least);
  }
}

TEST(SimulatedNetwork, RunsAsFastAsItGoesWhenAskedTo) {
  constexpr std::uint32_t count = 200;
  constexpr std::uint32_t bitrate_bps = 10'000;  // each frame takes 10 ms, at the least
  sim::Network network({.bitrate_bps = bitrate_bps, .speed = 0});
  const auto sender = network.join();
  const auto receiver = network.join();
  auto sending = in_thread([&] {
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(sender->send(numbered(i), guard), Result::ok);
    }
  });
  const std::vector<Received> received = receive_exactly(*receiver, count);
  result_of(sending);
  for (std::size_t i = 1; i < received.size(); ++i) {
    EXPECT_GE(received[i].time - received[i - 1].time, milliseconds(9)) << "frame " << i;
  }
}

TEST(SimulatedNetwork, JoinGivesUpWhereNoChipCanTakePart) {
  sim::Network network;
  hold_dominant(network, true);
  try {
    static_cast<void>(network.join({.open_timeout = no_wait}));
    ADD_FAILURE() << "joined a wire that is held";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(Errc::not_connected)) << error.what();
  }
  hold_dominant(network, false);
  EXPECT_NE(network.join(), nullptr);
}

TEST(SimulatedNetwork, RefusesWhatCannotBe) {
  EXPECT_THROW(sim::Network({.bitrate_bps = 0}), std::invalid_argument);
  EXPECT_THROW(sim::Network({.bitrate_bps = 1'000'000, .osc_hz = 8'000'000}),
               std::invalid_argument);
  EXPECT_THROW(sim::Network({.speed = -1}), std::invalid_argument);
}

TEST(SimulatedNetwork, PassesOnWhatAnActionThrows) {
  sim::Network network;
  EXPECT_THROW(
      network.in_simulation([](sim::CanBus&) { throw std::runtime_error("no such fault"); }),
      std::runtime_error);
}

}  // namespace
}  // namespace roio::test
