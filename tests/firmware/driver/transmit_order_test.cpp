// Frames leave in the order in which they were given, urgent ones first; each once, and what became
// of it is told truly.
//
// tests/firmware/mutation takes the driver's rules for that away one at a time, and sees these
// tests fail:
//   the second frame goes behind the first               ManyInARow, with two places
//   a buffer that is pending is left alone               the same
//   buffer 2 is for urgent frames                        the same
//   back to back, each pair goes behind the one before   BackToBackTrouble: contention
//   back to back, the seventh waits for the sixth        ManyInARow, with six places
//   urgent frames queue ahead of normal ones, and        UrgentFramesKeepTheirOrderAmongThemselves
//   behind urgent ones
//   a frame waits behind the queue                       TransmitTrouble: none
//   what became of a frame taken back is read            Abort.TakesBackWhatHasNotBegun
#include <algorithm>
#include <optional>
#include <random>
#include <string>

#include "rig.hpp"
#include "seed.hpp"
#include "sending.hpp"

namespace roio::test {
namespace {

/// The driver with two places for normal frames, and with six.
template <typename Traits>
class TransmitOrderOf : public testing::Test {
 protected:
  using SendingRig = Rig<false, 0, queue, Traits>;
};

struct NameOfPlaces {
  template <typename Traits>
  static std::string GetName(int) {
    return Traits::back_to_back ? "SixPlaces" : "TwoPlaces";
  }
};
using AllPlaces = testing::Types<TestTraits, BackToBack>;
TYPED_TEST_SUITE(TransmitOrderOf, AllPlaces, NameOfPlaces);

TYPED_TEST(TransmitOrderOf, ManyInARow) {
  for (std::uint32_t count = 1; count <= queue; ++count) {
    typename TestFixture::SendingRig rig;
    rig.begin();
    for (std::uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(rig.can.send(numbered(i), static_cast<std::uint8_t>(i)), Status::ok);
    }
    poll_until_idle(rig);
    EXPECT_EQ(numbers_of(rig.peer_received), counting(0, count));
    ASSERT_EQ(rig.can.traits().outcomes.size(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(rig.can.traits().outcomes[i],
                (Outcome{static_cast<std::uint8_t>(i), TxOutcome::sent}));
    }
    EXPECT_EQ(rig.can.counters().sent, count);
  }
}

TYPED_TEST(TransmitOrderOf, OneAfterAnotherWithoutAQueue) {
  Rig<false, 0, 0, TypeParam> rig;
  rig.begin();
  for (std::uint32_t i = 0; i < 300; ++i) {
    while (rig.can.send(numbered(i)) == Status::full) {
      rig.bus.run_for(microseconds(7));
    }
  }
  poll_until_idle(rig);
  EXPECT_EQ(numbers_of(rig.peer_received), counting(0, 300));
}

TYPED_TEST(TransmitOrderOf, AnUrgentFrameGoesAheadOfTenThatWait) {
  typename TestFixture::SendingRig rig;
  rig.begin();
  for (std::uint32_t i = 0; i < 10; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i)), Status::ok);
  }
  rig.bus.run_for(microseconds(50));  // the first is on the wire
  ASSERT_EQ(rig.can.send(numbered(100, 4, urgent_to_own)), Status::ok);
  poll_until_idle(rig);
  EXPECT_EQ(numbers_of(rig.peer_received),
            (std::vector<std::uint32_t>{0, 100, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TYPED_TEST(TransmitOrderOf, UrgentFramesKeepTheirOrderAmongThemselves) {
  typename TestFixture::SendingRig rig;
  rig.begin();
  for (std::uint32_t i = 0; i < 10; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i)), Status::ok);
    ASSERT_EQ(rig.can.send(numbered(100 + i, 4, urgent_to_own)), Status::ok);
  }
  poll_until_idle(rig);
  const std::vector<std::uint32_t> sent = numbers_of(rig.peer_received);
  std::vector<std::uint32_t> urgent;
  std::vector<std::uint32_t> normal;
  for (const std::uint32_t number : sent) {
    (number >= 100 ? urgent : normal).push_back(number);
  }
  EXPECT_EQ(urgent, counting(100, 10));
  EXPECT_EQ(normal, counting(0, 10));
  // Those that the chip had already may go between two urgent ones, and no others.
  const auto third = std::find(sent.begin(), sent.end(), 2U);
  EXPECT_EQ(std::count_if(sent.begin(), third, [](std::uint32_t n) { return n >= 100; }), 10);
}

TYPED_TEST(TransmitOrderOf, AnUrgentFrameIsNotHeldUpByANormalOneThatKeepsLosing) {
  // Somebody sends, without end, what beats our normal frames and not our urgent one.
  typename TestFixture::SendingRig rig;
  rig.begin();
  const Frame stronger{0x08000001, FrameKind::extended, 8, {}};
  rig.peer.on_sent([&](const Frame&) { rig.peer.send(stronger); });
  rig.peer.send(stronger);
  rig.peer.send(stronger);
  rig.bus.run_for(milliseconds(1));
  for (std::uint32_t i = 0; i < 4; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i)), Status::ok);
  }
  rig.bus.run_for(milliseconds(5));
  EXPECT_TRUE(rig.peer_received.empty()) << "normal ones lose";
  const sim::SimTime asked = rig.bus.now();
  ASSERT_EQ(rig.can.send(numbered(100, 4, urgent_to_own)), Status::ok);
  while (rig.peer_received.empty() && rig.bus.now() < asked + milliseconds(5)) {
    rig.bus.run_for(microseconds(20));
  }
  ASSERT_EQ(rig.peer_received.size(), 1U);
  EXPECT_EQ(number_of(rig.peer_received.front()), 100U);
  EXPECT_LT(rig.bus.now() - asked, 2 * sim::cycles(160, 500'000)) << "after the frame on the wire";
}

TEST(TransmitOrder, FullIsToldAndNothingIsStored) {
  Rig<false, 0, 2> rig;
  rig.begin();
  std::uint8_t taken = 0;
  while (rig.can.send(numbered(taken), taken) == Status::ok) {
    ++taken;
  }
  EXPECT_EQ(taken, 4) << "two in the chip, two in the queue";
  EXPECT_EQ(rig.can.send(numbered(taken), taken), Status::full);
  EXPECT_EQ(rig.can.send(numbered(9, 4, urgent_to_own), 9), Status::ok)
      << "the chip has a buffer for urgent ones";
  poll_until_idle(rig);
  EXPECT_EQ(rig.peer_received.size(), 5U);
}

struct Cautious : TestTraits {
  static constexpr bool only_buffer_0 = true;
};

TEST(TransmitOrder, WithBufferZeroAlone) {
  Rig<false, 0, queue, Cautious> rig;
  rig.begin();
  for (std::uint32_t i = 0; i < 10; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i)), Status::ok);
  }
  ASSERT_EQ(rig.can.send(numbered(100, 4, urgent_to_own)), Status::ok);
  while (rig.can.in_flight() > 0) {
    EXPECT_EQ(rig.chip.peek(0x40) & 8, 0) << "TXB1CTRL.TXREQ";
    EXPECT_EQ(rig.chip.peek(0x50) & 8, 0) << "TXB2CTRL.TXREQ";
    rig.bus.run_for(microseconds(20));
    ASSERT_EQ(rig.can.poll(), Status::ok);
  }
  EXPECT_EQ(numbers_of(rig.peer_received),
            (std::vector<std::uint32_t>{0, 100, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

/// Keeps the driver's queue full.
/// @return how much of the time the bus was busy.
template <typename AnyRig>
double fill_bus(AnyRig& rig) {
  constexpr std::uint32_t count = 600;
  const sim::SimTime start = rig.bus.now();
  std::uint32_t next = 0;
  while (rig.peer_received.size() < count) {
    while (next < count && rig.can.send(numbered(next, 8)) == Status::ok) {
      ++next;
    }
    rig.bus.run_for(microseconds(20));
    EXPECT_EQ(rig.can.poll(), Status::ok);
  }
  EXPECT_EQ(numbers_of(rig.peer_received), counting(0, count));
  return std::chrono::duration<double>(rig.bus.statistics().busy) /
         std::chrono::duration<double>(rig.bus.now() - start);
}

TEST(TransmitOrder, ABusyBusIsFilledButForOneGapInTwo) {
  SendingRig rig;
  rig.begin();
  EXPECT_GT(fill_bus(rig), 0.95);
}

TEST(TransmitOrder, BackToBackThereIsOneGapInSix) {
  Rig<false, 0, queue, BackToBack> rig;
  rig.begin();
  EXPECT_GT(fill_bus(rig), 0.98);
}

TEST(TransmitOrder, BackToBackTheSeventhWaitsForTheSixth) {
  Rig<false, 0, 0, BackToBack> rig;
  rig.begin();
  // Each of the first six enters while the one before it has just begun.
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(rig.can.send(numbered(i)), Status::ok) << i;
    while (rig.can.in_flight() > 1) {
      rig.bus.run_for(microseconds(20));
      ASSERT_EQ(rig.can.poll(), Status::ok);
    }
  }
  EXPECT_EQ(rig.can.send(numbered(6)), Status::full);
  EXPECT_EQ(rig.can.in_flight(), 1);
  poll_until_idle(rig);
  EXPECT_EQ(rig.can.send(numbered(6)), Status::ok);
  poll_until_idle(rig);
  EXPECT_EQ(numbers_of(rig.peer_received), counting(0, 7));
}

// --- against everything that can come between ----------------------------------------------------

struct Trouble {
  const char* name;
  double bit_errors = 0;
  bool contention = false;  ///< The peer sends frames that win and frames that lose, all the time.
  bool aborts = false;
  bool bus_off = false;  ///< Now and then the chip's own frames fail until it is bus-off.
  bool one_shot = false;
};

/// Prints a case in test names.
void PrintTo(const Trouble& trouble, std::ostream* out) {
  *out << trouble.name;
}

template <typename Traits>
class TroubleOf : public testing::TestWithParam<Trouble> {
 protected:
  TroubleOf() : generator_(seeded_generator()) {
    rig_.chip.on_sent([this](const Frame& frame) { sent_.push_back(frame); });
  }

  void begin() {
    rig_.begin(plain_config(mcp2515::Mode::normal, GetParam().one_shot));
    rig_.bus.set_bit_errors(GetParam().bit_errors, static_cast<std::uint32_t>(generator_()));
    if (GetParam().contention) {
      rig_.peer.on_sent([this](const Frame&) { contend(); });
      contend();
      contend();
    }
  }

  void contend() {
    const std::uint32_t id = up_to(generator_, 1) == 0 ? 0x00000100 : 0x1BFFFF00;
    rig_.peer.send({id, FrameKind::extended, static_cast<std::uint8_t>(up_to(generator_, 8)), {}});
  }

  /// One frame, urgent or not, carrying its number; its token is the number's low byte.
  void submit() {
    const bool urgent = up_to(generator_, 3) == 0;
    const Frame frame = numbered(number_, static_cast<std::uint8_t>(4 + up_to(generator_, 4)),
                                 urgent ? urgent_to_own : to_own);
    const Status status = rig_.can.send(frame, static_cast<std::uint8_t>(number_));
    if (status == Status::ok) {
      submitted_.push_back(frame);
      ++number_;
    } else {
      ASSERT_EQ(status, Status::full);
    }
  }

  void make_trouble() {
    if (GetParam().aborts && up_to(generator_, 60) == 0) {
      rig_.can.abort();
    }
    if (GetParam().bus_off && up_to(generator_, 400) == 0) {
      // Nothing that it sends shows on the wire, for as long as bus-off takes.
      rig_.chip.controller().cut_transmitter(true);
      rig_.bus.after(milliseconds(20), [this] { rig_.chip.controller().cut_transmitter(false); });
    }
  }

  void pass_time() {
    rig_.bus.run_for(microseconds(up_to(generator_, 200)));
    ASSERT_EQ(rig_.can.poll(), Status::ok);
  }

  void settle() {
    rig_.bus.set_bit_errors(0, 0);
    rig_.peer.on_sent({});
    // Bus-off takes 128 times 11 bits to end, and what waits goes out after that.
    poll_until_idle(rig_, std::chrono::seconds(3));
  }

  /// Outcomes in the order of submission; each frame has one. Tokens come round every 256 frames,
  /// many more than are ever under way.
  std::vector<TxOutcome> outcomes() {
    std::vector<std::optional<TxOutcome>> told(submitted_.size());
    std::size_t oldest = 0;
    for (const Outcome& outcome : rig_.can.traits().outcomes) {
      std::size_t i = oldest;
      while (i < told.size() && (told[i] || static_cast<std::uint8_t>(i) != outcome.token)) {
        ++i;
      }
      if (i == told.size()) {
        ADD_FAILURE() << "an outcome of no frame: " << outcome;
        break;
      }
      told[i] = outcome.outcome;
      while (oldest < told.size() && told[oldest]) {
        ++oldest;
      }
    }
    EXPECT_EQ(oldest, submitted_.size()) << "each frame has an outcome";
    std::vector<TxOutcome> result;
    result.reserve(told.size());
    for (const std::optional<TxOutcome>& one : told) {
      result.push_back(one.value_or(TxOutcome::unknown));
    }
    return result;
  }

  void expect_truth() {
    const std::vector<TxOutcome> told = outcomes();
    std::vector<Frame> urgent;
    std::vector<Frame> normal;
    std::size_t count = 0;
    for (std::size_t i = 0; i < submitted_.size(); ++i) {
      if (told[i] == TxOutcome::sent) {
        ++count;
        ((submitted_[i].id >> 28) == 0 ? urgent : normal).push_back(submitted_[i]);
      }
    }
    // What the chip itself put on the wire is the judge: each once, each in order.
    std::vector<Frame> urgent_sent;
    std::vector<Frame> normal_sent;
    for (const Frame& frame : sent_) {
      ((frame.id >> 28) == 0 ? urgent_sent : normal_sent).push_back(frame);
    }
    EXPECT_EQ(urgent_sent, urgent);
    EXPECT_EQ(normal_sent, normal);
    EXPECT_EQ(rig_.can.counters().sent, count);
    EXPECT_EQ(rig_.can.counters().sent + rig_.can.counters().not_sent, submitted_.size());
    EXPECT_EQ(rig_.can.counters().unknown, 0U);
    EXPECT_TRUE(rig_.chip.violations().empty()) << rig_.chip.violations().front().what;
    std::cout << count << " sent, " << submitted_.size() - count << " not, bus-off "
              << rig_.chip.events().bus_offs << " times\n";
  }

  void expect_each_sent_once_and_reported_truly() {
    begin();
    for (int round = 0; round < 6'000; ++round) {
      for (std::uint32_t i = up_to(generator_, 3); i > 0; --i) {
        ASSERT_NO_FATAL_FAILURE(submit());
      }
      make_trouble();
      ASSERT_NO_FATAL_FAILURE(pass_time());
    }
    settle();
    expect_truth();
    EXPECT_GT(sent_.size(), 200U);
    if (GetParam().bus_off) {
      EXPECT_GT(rig_.chip.events().bus_offs, 0U);
      EXPECT_GT(rig_.can.counters().bus_offs, 0U);
    }
    if (GetParam().aborts || GetParam().one_shot) {
      EXPECT_GT(rig_.can.counters().not_sent, 0U);
    }
  }

 private:
  std::mt19937 generator_;
  Rig<false, 0, queue, Traits> rig_;
  std::vector<Frame> submitted_;
  std::vector<Frame> sent_;
  std::uint32_t number_ = 0;
};

class TransmitTrouble : public TroubleOf<TestTraits> {};
class BackToBackTrouble : public TroubleOf<BackToBack> {};

TEST_P(TransmitTrouble, EachFrameIsSentOnceAndReportedTruly) {
  expect_each_sent_once_and_reported_truly();
}
TEST_P(BackToBackTrouble, EachFrameIsSentOnceAndReportedTruly) {
  expect_each_sent_once_and_reported_truly();
}

const auto troubles = testing::Values(
    Trouble{.name = "none"}, Trouble{.name = "contention", .contention = true},
    Trouble{.name = "bit_errors", .bit_errors = 0.0005},
    Trouble{.name = "bit_errors_and_contention", .bit_errors = 0.0005, .contention = true},
    Trouble{.name = "aborts", .aborts = true},
    Trouble{.name = "aborts_and_contention", .contention = true, .aborts = true},
    Trouble{.name = "bus_off", .bus_off = true},
    Trouble{.name = "bus_off_and_aborts", .aborts = true, .bus_off = true},
    Trouble{.name = "one_shot", .bit_errors = 0.0005, .contention = true, .one_shot = true},
    Trouble{.name = "one_shot_and_aborts",
            .bit_errors = 0.0005,
            .contention = true,
            .aborts = true,
            .one_shot = true},
    Trouble{.name = "everything",
            .bit_errors = 0.0005,
            .contention = true,
            .aborts = true,
            .bus_off = true});
constexpr auto name_of_trouble = [](const auto& row) { return std::string(row.param.name); };
INSTANTIATE_TEST_SUITE_P(All, TransmitTrouble, troubles, name_of_trouble);
INSTANTIATE_TEST_SUITE_P(All, BackToBackTrouble, troubles, name_of_trouble);

// --- abort: more of it in abort_test.cpp ---------------------------------------------------------

TEST(Abort, TakesBackWhatHasNotBegun) {
  SendingRig rig;
  rig.begin();
  for (std::uint8_t i = 0; i < 5; ++i) {
    ASSERT_EQ(rig.can.send(numbered(i), i), Status::ok);
  }
  rig.bus.run_for(microseconds(50));  // 0 is on the wire, 1 in the chip
  rig.can.abort();
  EXPECT_EQ(rig.can.send(numbered(9), 9), Status::full) << "until the chip has let go";
  poll_until_idle(rig);
  EXPECT_EQ(rig.can.traits().outcomes, (std::vector<Outcome>{{2, TxOutcome::aborted},
                                                             {3, TxOutcome::aborted},
                                                             {4, TxOutcome::aborted},
                                                             {1, TxOutcome::aborted},
                                                             {0, TxOutcome::sent}}));
  EXPECT_EQ(numbers_of(rig.peer_received), counting(0, 1));
  ASSERT_EQ(rig.can.poll(), Status::ok);
  EXPECT_EQ(rig.can.send(numbered(10), 10), Status::ok) << "and on again";
  poll_until_idle(rig);
  EXPECT_EQ(rig.can.traits().outcomes.back(), (Outcome{10, TxOutcome::sent}));
}

}  // namespace
}  // namespace roio::test
