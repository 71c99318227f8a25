// What the driver makes of what comes in, beside its order: lengths, kinds, losses, errors.
#include "rig.hpp"

namespace roio::test {
namespace {

TEST(Receive, EveryLengthArrivesUnchanged) {
  Rig<> rig;
  rig.begin();
  for (std::uint8_t length = 0; length <= 8; ++length) {
    Frame frame{to_own | length, FrameKind::extended, length, {1, 2, 3, 4, 5, 6, 7, 8}};
    rig.peer_sends({frame});
    Frame received{};
    std::fill(std::begin(received.data), std::end(received.data), std::uint8_t{0xEE});
    ASSERT_EQ(rig.can.receive(received), Status::ok);
    EXPECT_EQ(received, frame);
    for (unsigned i = length; i < 8; ++i) {
      EXPECT_EQ(received.data[i], 0) << "past the length";
    }
  }
}

TEST(Receive, EachIdentifierBitArrives) {
  Rig<> rig;
  FilterProgram<1> everything;
  ASSERT_EQ(everything.add({0, 0, FilterMeaning::everything}), Status::ok);
  rig.begin({bit_timing<16'000'000, 500'000>(), fit_mcp2515_in_order(everything)});
  for (unsigned bit = 0; bit < 29; ++bit) {
    const Frame frame{1U << bit, FrameKind::extended, 1, {static_cast<std::uint8_t>(bit)}};
    rig.peer_sends({frame});
    EXPECT_EQ(rig.receive_all(), std::vector{frame});
    ASSERT_EQ(rig.can.send(frame), Status::ok);
    rig.bus.run_for(milliseconds(1));
    EXPECT_EQ(rig.peer_received.back(), frame);
  }
}

TEST(Receive, ADlcAboveEightIsEightBytesAndNoMore) {
  for (std::uint8_t dlc = 9; dlc <= 15; ++dlc) {
    Rig<> rig;
    rig.begin();
    Frame sent{to_own, FrameKind::extended, dlc, {1, 2, 3, 4, 5, 6, 7, 8}};
    rig.peer_sends({sent, numbered(1)});
    struct {
      Frame frame;
      std::uint8_t behind[8];
    } room{};
    rig.mark();
    ASSERT_EQ(rig.can.receive(room.frame), Status::ok);
    sent.length = 8;
    EXPECT_EQ(room.frame, sent);
    EXPECT_TRUE(std::all_of(std::begin(room.behind), std::end(room.behind),
                            [](std::uint8_t byte) { return byte == 0; }));
    EXPECT_EQ(rig.receive_all(), std::vector{numbered(1)}) << "and it goes on";
  }
}

TEST(Receive, RemoteAndStandardFramesAreCountedAndDropped) {
  Rig<> rig;
  rig.begin();
  rig.peer_sends({{to_own, FrameKind::extended_remote, 3, {}}, numbered(1)});
  EXPECT_EQ(rig.receive_all(), std::vector{numbered(1)});
  EXPECT_EQ(rig.can.counters().foreign, 1U);
  // A chip that was told to take everything, as a driver without standard frames never does.
  rig.chip.receive({0x123, FrameKind::standard, 2, {1, 2}});
  EXPECT_EQ(rig.can.counters().foreign, 1U) << "the filters keep standard frames away";
  EXPECT_EQ(rig.can.counters().received, 1U);
}

TEST(Receive, WhileListeningEverybodysMessagesComeAndNoOtherKind) {
  // The chip lets everything through then, whatever its filters say (10.3).
  Rig<> rig;
  sim::HostNode witness(rig.bus, 500'000);
  rig.begin(plain_config(mcp2515::Mode::listen_only));
  constexpr std::uint32_t to_another = to_own ^ 0x2000;
  rig.peer_sends({{0x123, FrameKind::standard, 2, {1, 2}}});
  EXPECT_EQ(rig.receive_all(), std::vector<Frame>{});
  rig.peer_sends({{to_own, FrameKind::extended_remote, 3, {}}});
  EXPECT_EQ(rig.receive_all(), std::vector<Frame>{});
  EXPECT_EQ(rig.can.counters().foreign, 2U);
  rig.peer_sends({numbered(1)});
  EXPECT_EQ(rig.receive_all(), std::vector{numbered(1)});
  rig.peer_sends({numbered(2, 4, to_another)});
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered(2, 4, to_another)}));
  EXPECT_EQ(rig.can.counters().received, 2U);
}

struct AllKinds : TestTraits {
  static constexpr bool all_kinds = true;
};

TEST(Receive, EveryKindWhenAskedFor) {
  Rig<false, 4, 4, AllKinds> rig;
  rig.begin({plain_timing, mcp2515_filters_of_everything()});
  const std::vector<Frame> frames{{0x123, FrameKind::standard, 2, {1, 2}},
                                  {0x7FF, FrameKind::standard_remote, 4, {}},
                                  {0x000, FrameKind::standard, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
                                  {0x1FFFFFFF, FrameKind::extended_remote, 0, {}},
                                  {0x1FFFFFFF, FrameKind::extended, 1, {9}}};
  for (const Frame& frame : frames) {
    rig.peer_sends({frame});
    EXPECT_EQ(rig.receive_all(), std::vector{frame});
    ASSERT_EQ(rig.can.send(frame), Status::ok);
    rig.bus.run_for(milliseconds(1));
    ASSERT_EQ(rig.can.poll(), Status::ok);
    EXPECT_EQ(rig.peer_received.back(), frame);
  }
  EXPECT_EQ(rig.can.counters().foreign, 0U);
}

TEST(Receive, AFullQueueLeavesFramesInTheChip) {
  Rig<false, 2> rig;
  rig.begin();
  for (std::uint32_t i = 0; i < 4; ++i) {
    rig.peer_sends({numbered(i)});
    ASSERT_EQ(rig.can.poll(), Status::ok);
  }
  EXPECT_EQ(rig.chip.events().overflowed, 0U) << "two in the queue, two in the chip";
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered(0), numbered(1), numbered(2), numbered(3)}));
}

TEST(Receive, RefusesToSendWhatNoBusCarries) {
  struct Row {
    const char* why;
    Frame frame;
  };
  const Row rows[] = {
      {"nine bytes", {to_own, FrameKind::extended, 9, {}}},
      {"30 bits", {0x20000000, FrameKind::extended, 0, {}}},
      {"an error report", {4, FrameKind::error, 8, {}}},
      {"a standard frame, by a driver without them", {0x123, FrameKind::standard, 0, {}}},
      {"a remote frame, by a driver without them", {to_own, FrameKind::extended_remote, 0, {}}},
      {"no kind", {to_own, static_cast<FrameKind>(7), 0, {}}},
  };
  Rig<> rig;
  rig.begin();
  for (const Row& row : rows) {
    EXPECT_EQ(rig.can.send(row.frame), Status::bad_argument) << row.why;
  }
  EXPECT_EQ(rig.spent().first, 0U);
}

// --- losses --------------------------------------------------------------------------------------

TEST(Overflow, IsToldHoweverTheChipFlagsIt) {
  for (const bool as_rx0 : {false, true}) {
    for (const std::uint32_t frames : {3U, 4U, 9U}) {
      Rig<> polled({.chip = {.full_sets_rx0ovr = as_rx0}});
      Rig<true> interrupted({.chip = {.full_sets_rx0ovr = as_rx0}});
      const auto expect_told = [frames](auto& rig) {
        rig.begin();
        for (std::uint32_t i = 0; i < frames; ++i) {
          rig.chip.receive(numbered(i));
        }
        EXPECT_EQ(rig.receive_all(), (std::vector{numbered(0), numbered(1)}));
        EXPECT_EQ(rig.can.counters().overflows, 1U);
        EXPECT_EQ(rig.chip.events().overflowed, frames - 2);
        EXPECT_EQ(rig.chip.peek(0x2D) & 0xC0, 0) << "EFLG is ready for the next";
      };
      expect_told(polled);
      expect_told(interrupted);
    }
  }
}

TEST(Overflow, EachLossThatIsServedInBetweenIsCounted) {
  Rig<> rig;
  rig.begin();
  for (std::uint32_t round = 0; round < 20; ++round) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      rig.chip.receive(numbered(i));
    }
    rig.receive_all();
  }
  EXPECT_EQ(rig.can.counters().overflows, rig.chip.events().overflowed);
}

TEST(Overflow, IsCountedBeforeAnotherBeginForgetsIt) {
  Rig<> rig;
  rig.begin();
  for (std::uint32_t i = 0; i < 3; ++i) {
    rig.chip.receive(numbered(i));
  }
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  EXPECT_EQ(rig.can.counters().overflows, 1U);
}

TEST(Overflow, NothingIsClearedThatWasNotRead) {
  // A driver that clears receive flags itself loses the frame that came in between. This one never
  // writes them: it is enough that READ RX BUFFER does.
  Rig<> rig;
  rig.begin();
  std::uint32_t next = 0;
  bool armed = true;
  rig.wire.on_step([&] {
    if (std::exchange(armed, false)) {
      rig.chip.receive(numbered(next++));
    }
  });
  std::vector<Frame> received;
  for (int i = 0; i < 200; ++i) {
    armed = true;
    Frame frame{};
    if (rig.can.receive(frame) == Status::ok) {
      received.push_back(frame);
    }
  }
  for (const Frame& frame : rig.receive_all()) {
    received.push_back(frame);
  }
  EXPECT_EQ(received, rig.accepted);
  EXPECT_EQ(rig.chip.events().overflowed, 0U);
}

// --- the state of the bus ------------------------------------------------------------------------

template <bool WithLine>
void expect_states_are_told() {
  Rig<WithLine, 0, 4> rig;
  rig.begin();
  rig.peer.controller().set_mode(sim::Controller::Mode::off);
  ASSERT_EQ(rig.can.send(numbered(1), 1), Status::ok);
  std::vector<Mcp2515State> seen{rig.can.state()};
  const auto watch = [&](sim::SimTime span) {
    const sim::SimTime end = rig.bus.now() + span;
    while (rig.bus.now() < end) {
      rig.bus.run_for(microseconds(50));
      ASSERT_EQ(rig.can.poll(), Status::ok);
      if (rig.can.state() != seen.back()) {
        seen.push_back(rig.can.state());
      }
    }
  };
  watch(milliseconds(50));
  EXPECT_EQ(seen, (std::vector{Mcp2515State::active, Mcp2515State::warning, Mcp2515State::passive}))
      << "alone on the bus it goes no further";
  std::uint8_t transmit = 0;
  std::uint8_t receive = 0;
  rig.can.read_error_counters(transmit, receive);
  EXPECT_EQ(transmit, 128);
  EXPECT_EQ(receive, 0);
  // Now its transmitter is broken: nothing that it sends shows on the wire.
  rig.peer.controller().set_mode(sim::Controller::Mode::normal);
  rig.chip.controller().cut_transmitter(true);
  for (int i = 0; i < 1'000 && rig.chip.events().bus_offs == 0; ++i) {
    rig.bus.run_for(microseconds(100));
  }
  rig.chip.controller().cut_transmitter(false);
  ASSERT_EQ(rig.chip.controller().confinement(), sim::Confinement::bus_off);
  watch(milliseconds(1));
  EXPECT_EQ(seen.back(), Mcp2515State::bus_off);
  EXPECT_EQ(rig.can.counters().bus_offs, 1U);
  watch(milliseconds(10));
  EXPECT_EQ(seen.back(), Mcp2515State::active) << "recovered by itself";
  EXPECT_EQ(rig.can.traits().outcomes, (std::vector<Outcome>{{1, TxOutcome::sent}}));
  EXPECT_EQ(rig.peer_received, std::vector{numbered(1)}) << "once, after all";
  EXPECT_GT(rig.can.counters().message_errors, 0U);
}

TEST(BusState, IsToldWhilePolling) {
  expect_states_are_told<false>();
}
TEST(BusState, IsToldWithAnInterruptLine) {
  expect_states_are_told<true>();
}

TEST(Send, IsSettledInTheEndThoughNobodyAsks) {
  Rig<true, 2, 2, Mcp2515Traits> rig;
  rig.begin();
  ASSERT_EQ(rig.can.send(numbered(1)), Status::ok);
  rig.bus.run_for(milliseconds(1));
  for (int i = 0; i < 64; ++i) {
    ASSERT_EQ(rig.can.poll(), Status::ok);
  }
  EXPECT_EQ(rig.can.counters().sent, 1U);
  EXPECT_EQ(rig.can.in_flight(), 0);
}

// --- the chip goes away --------------------------------------------------------------------------

template <bool WithLine>
void expect_reset_is_noticed() {
  Rig<WithLine, 0, 4> rig;
  rig.begin();
  rig.peer.controller().set_mode(sim::Controller::Mode::off);
  ASSERT_EQ(rig.can.send(numbered(1), 1), Status::ok);
  rig.bus.run_for(microseconds(20));
  rig.chip.reset_pin();
  rig.bus.run_for(microseconds(50));
  EXPECT_EQ(rig.can.poll(), Status::no_chip) << "at once, as a frame is under way";
  EXPECT_FALSE(rig.can.running());
  EXPECT_EQ(rig.can.counters().chip_losses, 1U);
  EXPECT_EQ(rig.can.traits().outcomes, (std::vector<Outcome>{{1, TxOutcome::unknown}}))
      << "a lost request is no frame sent";
  EXPECT_EQ(rig.can.begin(plain_config()), Status::ok);
}

TEST(ChipLoss, AResetIsNoticedWhilePolling) {
  expect_reset_is_noticed<false>();
}
TEST(ChipLoss, AResetIsNoticedWithAnInterruptLine) {
  expect_reset_is_noticed<true>();
}

TEST(ChipLoss, ALineStuckHighIsNotTakenForAllBuffersInUse) {
  Rig<> rig;
  rig.begin();
  rig.peer.controller().set_mode(sim::Controller::Mode::off);  // nobody acknowledges
  ASSERT_EQ(rig.can.send(numbered(1)), Status::ok);
  ASSERT_EQ(rig.can.send(numbered(2)), Status::ok);
  ASSERT_EQ(rig.can.send(numbered(3, 4, urgent_to_own)), Status::ok);
  rig.wire.set_fault(sim::SpiWire::Fault::stuck_high);
  Frame frame{};
  EXPECT_EQ(rig.can.receive(frame), Status::no_chip);
  EXPECT_EQ(rig.can.counters().unknown, 3U);
}

struct Lean : Mcp2515Traits {
  static constexpr bool diagnoses = false;
};

TEST(ChipLoss, IsNoticedByAProgramThatOnlySends) {
  Rig<false, 0, 0, Lean> rig;
  rig.begin();
  rig.chip.reset_pin();
  rig.bus.run_for(microseconds(500));
  int calls = 1;
  while (rig.can.poll() == Status::ok && calls < 1'000) {
    ++calls;
  }
  EXPECT_EQ(calls, 64);
}

TEST(ChipLoss, ASilentLineIsNotBelievedForEver) {
  Rig<true> rig;
  rig.begin();
  rig.chip.reset_pin();
  rig.bus.run_for(microseconds(50));
  int calls = 1;
  while (rig.can.poll() == Status::ok && calls < 1'000) {
    ++calls;
  }
  EXPECT_EQ(calls, 64);
  EXPECT_EQ(rig.can.counters().chip_losses, 1U);
}

TEST(ChipLoss, AFrameReadFromAChipThatWasResetIsDiscarded) {
  for (int step = 0; step < 30; ++step) {
    Rig<true> rig;
    rig.begin();
    rig.peer_sends({numbered(0x5A5A5A5A, 8)});
    int so_far = 0;
    rig.wire.on_step([&] {
      if (so_far++ == step) {
        rig.chip.reset_pin();
      }
    });
    Frame frame{};
    if (rig.can.receive(frame) == Status::ok) {
      EXPECT_EQ(frame, numbered(0x5A5A5A5A, 8)) << step;
    }
  }
}

TEST(ChipLoss, TheQueueSurvivesALossThatSendFindsOut) {
  Rig<false, 0, 4> rig;
  rig.begin();
  rig.bus.hold_dominant(true);
  for (std::uint8_t i = 0; i < 4; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i), i), Status::ok);
  }
  rig.chip.reset_pin();
  rig.bus.run_for(microseconds(50));
  EXPECT_EQ(rig.can.send(numbered(4), 4), Status::no_chip);
  EXPECT_EQ(rig.can.in_flight(), 0);
  EXPECT_EQ(rig.can.waiting(), 2);
  rig.bus.hold_dominant(false);
  rig.bus.run_for(milliseconds(5));
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(rig.can.poll(), Status::ok);
    rig.bus.run_for(milliseconds(1));
  }
  EXPECT_EQ(rig.peer_received, (std::vector{numbered(2), numbered(3)}));
  EXPECT_EQ(rig.can.counters().unknown, 2U);
}

TEST(Send, IsRefusedWhileOnlyListening) {
  Rig<> rig;
  rig.begin(plain_config(mcp2515::Mode::listen_only));
  EXPECT_EQ(rig.can.send(numbered(1)), Status::wrong_mode);
}

TEST(ChipLoss, AFrameReadFromACableThatFellOffIsDiscarded) {
  // At each step of the call that reads it: what is handed out is the frame, or nothing.
  for (const auto fault : {sim::SpiWire::Fault::stuck_low, sim::SpiWire::Fault::stuck_high}) {
    for (int step = 0; step < 30; ++step) {
      Rig<> rig;
      rig.begin();
      rig.peer_sends({numbered(0x5A5A5A5A, 8), numbered(0x5A5A5A5A, 8)});
      int so_far = 0;
      rig.wire.on_step([&] {
        if (so_far++ == step) {
          rig.wire.set_fault(fault);
        }
      });
      Frame frame{};
      if (rig.can.receive(frame) == Status::ok) {
        EXPECT_EQ(frame, numbered(0x5A5A5A5A, 8)) << step;
      }
      EXPECT_EQ(rig.can.receive(frame), Status::no_chip) << step;
      EXPECT_EQ(rig.can.counters().chip_losses, 1U);
    }
  }
}

}  // namespace
}  // namespace roio::test
