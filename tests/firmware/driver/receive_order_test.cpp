// Frames come out in the order in which they were on the bus, whatever happens while they are read.
//
// tests/firmware/mutation takes the driver's rules for that away one at a time, and sees these
// tests fail:
//   the older frame is in RXB1 if that was full when RXB0   AFrameRollsOverWhileRxb0IsRead,
//   was freed, and is read first then                        EveryInterleaving...
//   no longer, once RXB1 has been read                       EveryInterleaving...
//   RXB0 first when both were filled unseen                  ReadsRxb0FirstWhenBothWereFilledUnseen
//   the look comes right after a buffer was freed            EveryInterleaving...
//   a look that was nonsense is repeated                     IsFoundAgainAfterALookThatWentWrong
//   a line that is low is no frame yet                       AnInterruptLineThatIsStuckLowIsNoFrame
#include "rig.hpp"
#include "sanitizers.hpp"
#include "soak.hpp"

namespace roio::test {
namespace {

// --- the ways in which drivers are known to go wrong, one by one ---------------------------------

/// A in RXB0; B comes before RXB0 is free, so it goes to RXB1; C comes right after, into RXB0. A
/// has been received then.
void receive_while_another_rolls_over(Rig<>& rig) {
  rig.begin();
  rig.chip.receive(numbered('A'));
  Frame frame{};
  // Steps of the first receive(): select, 2 bytes of status, deselect, select, 10 bytes of A,
  // deselect (A's buffer is free after it), select, 2 bytes of status, deselect.
  int step = 0;
  rig.wire.on_step([&] {
    ++step;
    if (step == 8) {
      rig.chip.receive(numbered('B'));
    }
    if (step == 17) {
      rig.chip.receive(numbered('C'));
    }
  });
  EXPECT_EQ(rig.can.receive(frame), Status::ok);
  EXPECT_EQ(frame, numbered('A'));
  rig.wire.on_step(nullptr);
  EXPECT_EQ(rig.chip.peek(0x2C) & 3, 3) << "both buffers are full, RXB1 with the older frame";
}

TEST(ReceiveOrder, AFrameRollsOverWhileRxb0IsRead) {
  Rig<> rig;
  receive_while_another_rolls_over(rig);
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered('B'), numbered('C')}));
}

TEST(ReceiveOrder, BothAreCountedWhenTheyAreForgotten) {
  Rig<> rig;
  receive_while_another_rolls_over(rig);
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  EXPECT_EQ(rig.can.counters().discarded, 2U);
}

TEST(ReceiveOrder, BothFullAndOneReadALoopStarvesNobody) {
  Rig<> rig;
  rig.begin();
  std::vector<Frame> sent;
  std::vector<Frame> received;
  for (std::uint32_t i = 0; i < 2; ++i) {
    sent.push_back(numbered(i));
    rig.chip.receive(sent.back());
  }
  for (std::uint32_t i = 2; i < 50; ++i) {
    Frame frame{};
    ASSERT_EQ(rig.can.receive(frame), Status::ok);
    received.push_back(frame);
    sent.push_back(numbered(i));
    rig.chip.receive(sent.back());
  }
  for (const Frame& frame : rig.receive_all()) {
    received.push_back(frame);
  }
  EXPECT_EQ(received, sent);
}

TEST(ReceiveOrder, ReadsRxb0FirstWhenBothWereFilledUnseen) {
  Rig<> rig;
  rig.begin();
  rig.peer_sends({numbered(1), numbered(2)});
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered(1), numbered(2)}));
}

TEST(ReceiveOrder, WhatWasSeenStaysTrueHoweverLateItIsUsed) {
  // The look after A shows B in RXB0 alone; long after, C has rolled over into RXB1.
  Rig<> rig;
  rig.begin();
  rig.chip.receive(numbered('A'));
  bool comes = true;
  int step = 0;
  rig.wire.on_step([&] {
    if (++step == 17 && std::exchange(comes, false)) {
      rig.chip.receive(numbered('B'));  // right after A's buffer was freed
    }
  });
  Frame frame{};
  ASSERT_EQ(rig.can.receive(frame), Status::ok);
  ASSERT_EQ(rig.chip.peek(0x2C) & 3, 1) << "B is in RXB0";
  rig.chip.receive(numbered('C'));
  ASSERT_EQ(rig.can.receive(frame), Status::ok);
  EXPECT_EQ(frame, numbered('B'));
  rig.chip.receive(numbered('D'));  // into RXB0, younger than C in RXB1
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered('C'), numbered('D')}));
}

TEST(ReceiveOrder, AStatusReadForSendingKnowsTheOrderToo) {
  // B alone in RXB1; send() looks at the status; then C comes into RXB0.
  Rig<> rig;
  rig.begin();
  rig.chip.receive(numbered('A'));
  rig.chip.receive(numbered('B'));
  Frame frame{};
  ASSERT_EQ(rig.can.receive(frame), Status::ok);
  ASSERT_EQ(frame, numbered('A'));
  for (std::uint32_t i = 0; i < 3; ++i) {
    static_cast<void>(rig.can.send(numbered(i)));  // the third finds the chip full, and asks it
  }
  rig.chip.receive(numbered('C'));
  static_cast<void>(rig.can.send(numbered(3)));
  EXPECT_EQ(rig.receive_all(), (std::vector{numbered('B'), numbered('C')}));
}

TEST(ReceiveOrder, IsNotGuessedAfterALookThatWentWrong) {
  // B is in RXB1 when A has been read, and the look that would have shown it comes back as
  // nonsense. Another look could not tell whether A was freed, and which is older: the loss is
  // told.
  Rig<> rig;
  rig.begin();
  rig.chip.receive(numbered('A'));
  rig.chip.receive(numbered('B'));
  rig.wire.lose_select_after(13);  // 2 of status, 10 of A, the look's instruction
  Frame frame{};
  EXPECT_EQ(rig.can.receive(frame), Status::no_chip);
  EXPECT_EQ(rig.can.counters().chip_losses, 1U);
  EXPECT_EQ(rig.can.counters().discarded, 1U);
  ASSERT_EQ(rig.can.begin(plain_config()), Status::ok);
  rig.chip.receive(numbered('C'));
  EXPECT_EQ(rig.receive_all(), std::vector{numbered('C')});
}

TEST(ReceiveOrder, ASpikeInAnIdleLookIsForgiven) {
  Rig<> rig;
  rig.begin();
  rig.wire.lose_select_after(1);  // the look's instruction
  Frame frame{};
  EXPECT_EQ(rig.can.receive(frame), Status::empty);
  rig.chip.receive(numbered('A'));
  EXPECT_EQ(rig.receive_all(), std::vector{numbered('A')});
  EXPECT_EQ(rig.can.counters().chip_losses, 0U);
}

TEST(ReceiveOrder, ASpikeOnTheInterruptLineIsNoFrame) {
  Rig<true> rig;
  rig.begin();
  rig.peer_sends({numbered(1)});
  ASSERT_EQ(rig.receive_all(), std::vector{numbered(1)});
  rig.wire.spike_on_interrupt_line();
  EXPECT_TRUE(rig.receive_all().empty()) << "what RXB0 held before is not handed out again";
  EXPECT_EQ(rig.can.counters().received, 1U);
  rig.peer_sends({numbered(2)});
  EXPECT_EQ(rig.receive_all(), std::vector{numbered(2)});
}

TEST(ReceiveOrder, AnInterruptLineThatIsStuckLowIsNoFrame) {
  Rig<true> rig;
  rig.begin();
  rig.wire.hold_interrupt_line_low(true);
  rig.peer_sends({numbered(1)});
  for (int i = 0; i < 100; ++i) {
    Frame frame{};
    EXPECT_EQ(rig.can.receive(frame), i == 0 ? Status::ok : Status::empty);
  }
  EXPECT_EQ(rig.can.counters().received, 1U);
}

// --- every interleaving --------------------------------------------------------------------------

/// What the program does over and over until all is received.
enum class Program : std::uint8_t { receives, polls_and_receives, sends_and_receives };

/// Frames come at chosen steps of the SPI: before any byte, and before any edge of chip select.
template <bool WithLine, std::uint8_t RxQueue>
class Interleaving {
 public:
  explicit Interleaving(Program program) : program_(program) {
    rig_.begin();
    rig_.wire.on_step([this] { step(); });
  }

  /// @param before frames that are there when it begins, 0 to 2.
  /// @param events steps at which one comes, ascending.
  /// @return how many steps it took.
  std::size_t run(std::uint32_t before, const std::vector<std::size_t>& events) {
    rig_.accepted.clear();
    count_ = 0;
    for (std::uint32_t i = 0; i < before; ++i) {
      rig_.chip.receive(numbered(count_++));
    }
    events_ = events;
    next_ = 0;
    step_ = 0;
    std::vector<Frame> received;
    for (int idle = 0; idle < 3 || next_ < events_.size();) {
      const std::size_t before_call = step_;
      const std::size_t come = next_;
      work();
      Frame frame{};
      if (rig_.can.receive(frame) == Status::ok) {
        received.push_back(frame);
        idle = 0;
      } else {
        ++idle;
      }
      if (step_ == before_call) {
        step();  // a call that needs no SPI takes its time, too
      }
      if (next_ != come) {
        idle = 0;
      }
    }
    const std::size_t steps = step_;
    next_ = events_.size();
    EXPECT_EQ(received, rig_.accepted) << text();
    EXPECT_EQ(rig_.can.counters().line_losses, 0U) << text();
    rig_.peer_received.clear();
    rig_.can.traits().outcomes.clear();
    return steps;
  }

  /// Whether each frame found a buffer.
  [[nodiscard]] bool all_accepted() const { return rig_.accepted.size() == count_; }

 private:
  void step() {
    if (next_ < events_.size() && step_ == events_[next_]) {
      rig_.chip.receive(numbered(count_++));
      ++next_;
    }
    ++step_;
  }

  void work() {
    if (program_ == Program::polls_and_receives) {
      ASSERT_EQ(rig_.can.poll(), Status::ok);
    } else if (program_ == Program::sends_and_receives) {
      static_cast<void>(rig_.can.send(numbered(99)));
    }
  }

  [[nodiscard]] std::string text() const {
    std::string text = "frames come at steps";
    for (const std::size_t event : events_) {
      text += ' ' + std::to_string(event);
    }
    return text;
  }

  Program program_;
  Rig<WithLine, RxQueue> rig_;
  std::vector<std::size_t> events_;
  std::size_t next_ = 0;
  std::size_t step_ = 0;
  std::uint32_t count_ = 0;
};

/// Fewer steps than two frames can be apart: more than from freeing RXB0 to the look after it
/// (raise chip select, lower it, two bytes), less than any frame takes on the bus.
constexpr std::size_t apart = 5;

/// scripts/soak takes every choice of steps. Else the last of three frames comes at one step in
/// five, which begins anew with each choice of the others: no step is left out. A sanitizer needs
/// the paths, not all the moments, and takes one in eleven.
std::size_t stride_of_choices() {
  return is_soak() ? 1 : is_instrumented ? 11 : 5;
}

/// Three frames at every choice of steps.
template <bool WithLine, std::uint8_t RxQueue>
void expect_order_at_every_interleaving(Program program) {
  Interleaving<WithLine, RxQueue> interleaving(program);
  const std::size_t stride = stride_of_choices();
  std::size_t runs = 0;
  std::size_t lossless = 0;
  for (std::uint32_t before = 0; before <= 2; ++before) {
    // As many steps as reading it all takes; an event at a later step is one at the next begin.
    const std::size_t end = interleaving.run(before, {0, 40, 80}) + 1;
    for (std::size_t first = 0; first < end; ++first) {
      for (std::size_t second = first + apart; second < end; ++second) {
        for (std::size_t third = second + apart + second % stride; third < end; third += stride) {
          interleaving.run(before, {first, second, third});
          ++runs;
          lossless += interleaving.all_accepted() ? 1U : 0U;
          if (testing::Test::HasFailure()) {
            return;
          }
        }
      }
    }
  }
  EXPECT_GT(runs, 10'000U / stride);
  EXPECT_GT(lossless, runs / 4) << "enough of them leave the chip room";
}

TEST(ReceiveOrder, EveryInterleavingWhilePolling) {
  expect_order_at_every_interleaving<false, 0>(Program::receives);
}

TEST(ReceiveOrder, EveryInterleavingWithAnInterruptLine) {
  expect_order_at_every_interleaving<true, 0>(Program::receives);
}

TEST(ReceiveOrder, EveryInterleavingWithAQueue) {
  expect_order_at_every_interleaving<false, 3>(Program::polls_and_receives);
}

TEST(ReceiveOrder, EveryInterleavingWithAQueueAndAnInterruptLine) {
  expect_order_at_every_interleaving<true, 3>(Program::polls_and_receives);
}

TEST(ReceiveOrder, EveryInterleavingWhileSending) {
  expect_order_at_every_interleaving<false, 0>(Program::sends_and_receives);
}

}  // namespace
}  // namespace roio::test
