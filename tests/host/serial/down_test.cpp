// Frames to the bridge: in order, once, and with an outcome.
#include <algorithm>

#include "line.hpp"
#include "serial/down.hpp"

namespace roio::test {
namespace {

using serial::DownFrames;
using serial::Outcome;

std::vector<Frame> numbers(std::uint32_t from, std::uint32_t to) {
  std::vector<Frame> frames;
  for (std::uint32_t i = from; i < to; ++i) {
    frames.push_back(numbered(i));
  }
  return frames;
}

void expect_numbers(const std::vector<Frame>& frames, std::uint32_t from, std::uint32_t to) {
  ASSERT_EQ(frames.size(), to - from);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(number_of(frames[i]), from + i);
  }
}

TEST(SerialDown, FramesAreSentInOrderAndAnswered) {
  Line line;
  line.open();
  EXPECT_EQ(line.session.offer(numbers(0, 60), line.now), 60U);
  EXPECT_FALSE(line.session.all_done());
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 100ms));
  expect_numbers(line.bridge.on_bus, 0, 60);
  EXPECT_EQ(line.session.down().sent, 60U);
  EXPECT_EQ(line.session.down().resent, 0U);
}

TEST(SerialDown, NoneAreTakenWithoutASession) {
  Line line;
  EXPECT_EQ(line.session.offer(numbers(0, 1), line.now), 0U);
  line.session.begin(line.now);
  EXPECT_EQ(line.session.offer(numbers(0, 1), line.now), 0U);
}

TEST(SerialDown, LanesHold64Each) {
  Line line;
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 16), line.now), 16U);
  line.run_for(50ms);
  EXPECT_EQ(line.session.offer(numbers(0, 100), line.now), 64U);
  EXPECT_EQ(line.session.offer(std::vector(100, numbered(1, 0x0000400A)), line.now), 64U);
  EXPECT_EQ(line.session.offer(numbers(0, 1), line.now), 0U);
  EXPECT_EQ(line.session.waiting(), 128U);
}

TEST(SerialDown, UrgentFramesPassThoseThatWait) {
  Line line;
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 40), line.now), 40U);
  line.run_for(20ms);
  ASSERT_EQ(line.session.offer(std::vector{numbered(99, 0x0000400A)}, line.now), 1U);
  line.bridge.bus_is_free = true;
  line.bridge.finish(16);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 100ms));
  ASSERT_EQ(line.bridge.on_bus.size(), 41U);
  EXPECT_EQ(number_of(line.bridge.on_bus[16]), 99U) << "the window was full of 16";
}

TEST(SerialDown, OneWaitsForTheOutcomeOfThe16thBefore) {
  Line line;
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 60), line.now), 60U);
  line.run_for(300ms);
  EXPECT_EQ(line.bridge.waiting(), 16U);
  line.bridge.finish(3);
  line.run_for(300ms);
  EXPECT_EQ(line.bridge.on_bus.size(), 19U);
  line.bridge.bus_is_free = true;
  line.bridge.finish(16);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 100ms));
  expect_numbers(line.bridge.on_bus, 0, 60);
  EXPECT_EQ(line.session.down().resent, 0U);
}

TEST(SerialDown, NoMoreGoesOutThanTheBridgesBufferHolds) {
  Line line;
  line.open();
  line.bridge.may_send = losing(serial::Up::results, 1000);
  const std::size_t before = line.session.output().size();
  ASSERT_EQ(line.session.offer(numbers(0, 60), line.now), 60U);
  EXPECT_LE(line.session.output().size() - before, DownFrames::max_untaken);
  EXPECT_GT(line.session.output().size() - before, DownFrames::max_untaken - 40);
}

TEST(SerialDown, OutcomesAreCounted) {
  Line line;
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 6), line.now), 6U);
  line.run_for(20ms);
  line.bridge.finish(1, Outcome::sent);
  line.bridge.finish(2, Outcome::not_sent);
  line.bridge.finish(3, Outcome::unknown);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 100ms));
  EXPECT_EQ(line.session.down().sent, 1U);
  EXPECT_EQ(line.session.down().not_sent, 2U);
  EXPECT_EQ(line.session.down().unknown, 3U);
}

/// Spoils the bytes from one to another one of what goes down from now on.
auto spoiling(int from, int to) {
  return [from, to, at = 0](std::uint8_t byte) mutable {
    const bool spoil = at >= from && at < to;
    ++at;
    return std::optional(static_cast<std::uint8_t>(spoil ? byte ^ 0x55 : byte));
  };
}

TEST(SerialDown, AFrameThatIsDamagedIsSentAgainWithAllAfterIt) {
  Line line;
  line.open();
  line.down_fault = spoiling(20, 22);
  ASSERT_EQ(line.session.offer(numbers(0, 30), line.now), 30U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 90ms))
      << "at once, without a timeout";
  expect_numbers(line.bridge.on_bus, 0, 30);
  EXPECT_GE(line.session.down().resent, 1U);
  EXPECT_LE(line.session.down().resent, 16U);
}

TEST(SerialDown, TheLastFrameIsSentAgainAfterATime) {
  Line line;
  line.open();
  line.down_fault = spoiling(2, 4);
  ASSERT_EQ(line.session.offer(numbers(0, 1), line.now), 1U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 150ms));
  expect_numbers(line.bridge.on_bus, 0, 1);
  EXPECT_EQ(line.session.down().resent, 1U);
}

TEST(SerialDown, ResultsThatAreLostAreMadeUpByTheNext) {
  Line line;
  line.open();
  line.bridge.may_send = losing(serial::Up::results, 5);
  ASSERT_EQ(line.session.offer(numbers(0, 40), line.now), 40U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 500ms));
  expect_numbers(line.bridge.on_bus, 0, 40);
  EXPECT_EQ(line.session.down().sent, 40U);
}

TEST(SerialDown, ResultsThatNoneComesAfterEndTheSessionAndAreUnknown) {
  Line line;
  line.open();
  line.bridge.may_send = losing(serial::Up::results, 1000);
  ASSERT_EQ(line.session.offer(numbers(0, 3), line.now), 3U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }, 1200ms));
  EXPECT_EQ(line.session.down().unknown, 3U);
  line.bridge.may_send = nullptr;
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }));
  ASSERT_EQ(line.session.offer(numbers(3, 4), line.now), 1U);
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }));
  expect_numbers(line.bridge.on_bus, 0, 4);
}

TEST(SerialDown, WhatABridgeMayHaveSentIsNotSentAgain) {
  Line line;
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 60), line.now), 60U);
  line.run_for(50ms);
  const std::size_t taken = line.bridge.on_bus.size();
  ASSERT_EQ(taken, 16U);
  line.bridge.finish(4);
  line.bridge.out.clear();  // and this is not heard any more
  line.bridge.reset();
  line.bridge.bus_is_free = true;
  ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions == 2; }));
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }));
  expect_numbers(line.bridge.on_bus, 0, 60);
  EXPECT_EQ(line.session.down().unknown, 16U);
  EXPECT_EQ(line.session.down().sent, 44U) << "what had no number yet goes in the next session";
}

TEST(SerialDown, TheNumbersGoRoundManyTimes) {
  Line line;
  line.open();
  std::uint32_t offered = 0;
  while (offered < 2000) {
    offered += static_cast<std::uint32_t>(
        line.session.offer(numbers(offered, std::min(offered + 16, 2000U)), line.now));
    line.run_for(1ms);
  }
  ASSERT_TRUE(line.run_until([&] { return line.session.all_done(); }));
  expect_numbers(line.bridge.on_bus, 0, 2000);
  EXPECT_EQ(line.session.down().sent, 2000U);
}

// --- life ----------------------------------------------------------------------------------------

/// The life in the records of frames that the bridge has heard, in milliseconds; 0xFFFF: for ever.
std::vector<int> lives(const ScriptedBridge& bridge) {
  std::vector<int> all;
  for (const Bytes& body : bridge.frame_records) {
    const std::uint8_t life = body.at(serial::life_at);
    all.push_back(life == serial::life_forever
                      ? 0xFFFF
                      : serial::life_units(life) * serial::life_unit_us / 1000);
  }
  return all;
}

TEST(SerialLife, WhatIsLeftIsInTheRecord) {
  Line line({.lifetime = 500ms});
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 20), line.now), 20U);
  line.run_for(300ms);  // 16 have gone, 4 wait for room
  line.bridge.finish(16);
  line.run_for(50ms);
  const std::vector<int> told = lives(line.bridge);
  ASSERT_EQ(told.size(), 20U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(told[i], 491) << "less the time on the line, and rounded down";
  }
  for (std::size_t i = 16; i < 20; ++i) {
    EXPECT_LE(told[i], 200);
    EXPECT_GE(told[i], 170);
  }
}

TEST(SerialLife, ForEverIsForEver) {
  Line line({.lifetime = forever});
  line.open();
  ASSERT_EQ(line.session.offer(numbers(0, 1), line.now), 1U);
  line.run_for(50ms);
  EXPECT_EQ(lives(line.bridge), std::vector<int>{0xFFFF});
}

TEST(SerialLife, WhatIsSentAgainHasLessLeft) {
  Line line({.lifetime = 500ms});
  line.open();
  line.bridge.may_take = [](const Bytes&) { return false; };  // as one without a controller
  ASSERT_EQ(line.session.offer(numbers(0, 1), line.now), 1U);
  line.run_for(450ms);
  const std::vector<int> told = lives(line.bridge);
  ASSERT_GE(told.size(), 4U);
  for (std::size_t i = 1; i < told.size(); ++i) {
    EXPECT_LE(told[i], told[i - 1] - 80) << i;
  }
  line.run_for(200ms);
  EXPECT_EQ(lives(line.bridge).back(), 0) << "over: the number is used up";
}

TEST(SerialLife, WhatWaitsInVainIsDroppedAtItsEndAndCounted) {
  Line line({.lifetime = 500ms});
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 40), line.now), 40U);
  line.run_for(495ms);
  EXPECT_EQ(line.session.down().dropped, 0U);
  line.run_for(10ms);
  EXPECT_EQ(line.session.down().dropped, 24U) << "but for the window's 16";
  EXPECT_EQ(line.session.unsettled(), 16U);
  line.bridge.finish(16, Outcome::not_sent);
  line.run_for(50ms);
  EXPECT_TRUE(line.session.all_done());
  EXPECT_EQ(line.session.down().not_sent, 16U);
}

TEST(SerialLife, ALostBridgeDoesNotGetThemLater) {
  Line line({.lifetime = 500ms});
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 40), line.now), 40U);
  line.run_for(50ms);
  line.bridge.is_deaf = true;
  line.run_for(1s);
  EXPECT_EQ(line.session.down().dropped, 24U);
  line.bridge.is_deaf = false;
  line.bridge.bus_is_free = true;
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }));
  line.run_for(100ms);
  EXPECT_EQ(line.bridge.on_bus.size(), 16U) << "those of the first session";
}

TEST(SerialLife, AlsoWithoutAPort) {
  Line line({.lifetime = 500ms});
  line.open();
  line.bridge.bus_is_free = false;
  ASSERT_EQ(line.session.offer(numbers(0, 40), line.now), 40U);
  line.run_for(50ms);
  line.session.end();
  EXPECT_LE(line.session.deadline(), line.now + 500ms);
  line.session.on_time(line.now + 500ms);
  EXPECT_EQ(line.session.down().dropped, 24U);
  EXPECT_EQ(line.session.deadline(), Time::max());
}

// --- the window by itself ------------------------------------------------------------------------

/// Slots that all have this outcome.
constexpr std::uint32_t all(Outcome outcome) {
  return static_cast<std::uint32_t>(outcome) * 0x55555555U;
}

constexpr Time never = Time::max();

std::size_t send_all(DownFrames& down) {
  std::size_t count = 0;
  while (down.next()) {
    ++count;
  }
  return count;
}

TEST(SerialWindow, ASlotTellsNothingOfAFrameThatIsNotTaken) {
  DownFrames down;
  ASSERT_EQ(down.offer(numbers(0, 40), never), 40U);
  ASSERT_EQ(send_all(down), 11U);
  ASSERT_EQ(down.results(11, all(Outcome::sent)), DownFrames::Progress::some);
  // 16..21 have the slots of 0..5 from now on, but in the bridge not yet.
  ASSERT_EQ(send_all(down), 11U);
  EXPECT_EQ(down.results(11, all(Outcome::not_sent)), DownFrames::Progress::none);
  EXPECT_EQ(down.results(16, all(Outcome::sent)), DownFrames::Progress::some);
  EXPECT_EQ(down.counters().sent, 16U);
  EXPECT_EQ(down.counters().not_sent, 0U);
  EXPECT_TRUE(down.awaits_outcome());
}

TEST(SerialWindow, WhatLiesOutsideOfItIsNonsense) {
  DownFrames down;
  EXPECT_EQ(down.results(1, 0), DownFrames::Progress::nonsense);
  ASSERT_EQ(down.offer(numbers(0, 5), never), 5U);
  ASSERT_EQ(send_all(down), 5U);
  EXPECT_EQ(down.results(6, all(Outcome::sent)), DownFrames::Progress::nonsense);
  EXPECT_EQ(down.results(255, all(Outcome::sent)), DownFrames::Progress::nonsense);
  EXPECT_EQ(down.counters().sent, 0U);
  EXPECT_EQ(down.results(5, all(Outcome::pending)), DownFrames::Progress::some);
  EXPECT_EQ(down.results(4, all(Outcome::sent)), DownFrames::Progress::nonsense) << "it goes back";
  EXPECT_EQ(down.results(5, all(Outcome::sent)), DownFrames::Progress::some);
  EXPECT_EQ(down.results(5, all(Outcome::sent)), DownFrames::Progress::none);
  EXPECT_TRUE(down.done());
}

TEST(SerialWindow, GoingBackSendsTheSameNumbersAgain) {
  DownFrames down;
  ASSERT_EQ(down.offer(numbers(0, 4), never), 4U);
  ASSERT_EQ(send_all(down), 4U);
  ASSERT_EQ(down.results(1, all(Outcome::pending)), DownFrames::Progress::some);
  down.go_back();
  EXPECT_EQ(down.sequence(), 1);
  const auto again = down.next();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->sequence, 1);
  EXPECT_EQ(number_of(again->frame), 1U);
  // Meanwhile what was sent first has come after all.
  ASSERT_EQ(down.results(4, all(Outcome::sent)), DownFrames::Progress::some);
  EXPECT_EQ(down.sequence(), 4);
  EXPECT_FALSE(down.next());
  EXPECT_TRUE(down.done());
  EXPECT_EQ(down.counters().resent, 1U);
}

TEST(SerialWindow, WhatIsDroppedIsCounted) {
  DownFrames down;
  ASSERT_EQ(down.offer(numbers(0, 64), never), 64U);
  const std::size_t sent = send_all(down);
  down.drop_waiting();
  down.begin();
  EXPECT_TRUE(down.done());
  EXPECT_EQ(down.counters().unknown, sent);
  EXPECT_EQ(down.counters().dropped, 64 - sent);
}

}  // namespace
}  // namespace roio::test
