// The line rate of a session: how it is tried, and when it goes down.
#include "line.hpp"

namespace roio::test {
namespace {

/// Spoils one byte in so many.
std::function<std::optional<std::uint8_t>(std::uint8_t)> spoiling(const std::function<bool()>& when,
                                                                  int one_in) {
  return [when, one_in, count = 0](std::uint8_t byte) mutable {
    const bool spoil = when() && ++count % one_in == 0;
    return std::optional(static_cast<std::uint8_t>(byte ^ (spoil ? 0x10 : 0)));
  };
}

TEST(SerialRate, IsLowerWhenTheTrialFails) {
  Line line;
  line.up_fault = spoiling([&] { return line.bridge.rate_bps >= 500'000; }, 20);
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 250'000U);
  EXPECT_EQ(line.session.counters().failed_trials, 2U);
}

TEST(SerialRate, GarbageThatTheChangeOfRateMakesIsNoDamagedRecord) {
  Line line;
  bool put = false;
  line.at_each_step = [&] {
    if (!put && line.session.phase() == Phase::trying) {
      put = true;
      for (const std::uint8_t byte : Bytes{0x00, 0xFF, 0x55}) {  // the last one first
        line.bridge.out.push_front({byte, 1'000'000});
      }
    }
  };
  line.open();
  EXPECT_TRUE(put);
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
  EXPECT_EQ(line.session.counters().damaged, 0U);
}

TEST(SerialRate, IsLowerWhenNothingComesBack) {
  Line line({.line_rate_bps = 2'000'000});
  line.down_fault = [&line](std::uint8_t byte) {
    return line.bridge.rate_bps == 2'000'000 ? std::nullopt : std::optional(byte);
  };
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
  EXPECT_EQ(line.session.counters().failed_trials, 1U);
}

TEST(SerialRate, StandsTheTrialWhenTheBridgeHadNoRoomForAnEcho) {
  Line line;
  line.bridge.may_send = losing(serial::Up::echoed, 2);
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
  EXPECT_EQ(line.session.counters().failed_trials, 0U);
}

TEST(SerialRate, IsTriedAgainWhenTheReplyWasLost) {
  Line line;
  line.bridge.may_send = losing(serial::Up::reply);
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
  EXPECT_EQ(line.session.counters().sessions, 2U);
}

TEST(SerialRate, IsGivenUpWhenItIsNeverAnswered) {
  Line line;
  line.bridge.verdict = [&](serial::Down operation) -> std::optional<std::uint8_t> {
    const bool fast = operation == serial::Down::speed && line.bridge.heard.back().at(4) != 0x07;
    return fast ? std::nullopt : std::optional<std::uint8_t>(0);
  };
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 500'000U) << "07A120";
}

TEST(SerialRate, IsAnotherOneWhenTheBridgeRefuses) {
  Line line;
  line.bridge.verdict = [&](serial::Down operation) -> std::uint8_t {
    return operation == serial::Down::speed && line.bridge.heard.back().at(4) == 0x0F ? 1 : 0;
  };
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 500'000U);
  EXPECT_EQ(line.session.counters().sessions, 1U);
}

TEST(SerialRate, GoesDownWhenRecordsAreDamagedOften) {
  Line line;
  line.open();
  line.up_fault = spoiling([&] { return line.bridge.rate_bps >= 1'000'000; }, 90);
  std::uint32_t sent = 0;
  line.at_each_step = [&, next = line.now]() mutable {
    if (line.now >= next) {
      line.bridge.hear(numbered(sent++), line.now);
      next += 1ms;
    }
  };
  ASSERT_TRUE(line.run_until([&] { return line.session.line_rate_bps() == 500'000; }));
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }));
  EXPECT_EQ(line.session.counters().step_downs, 1U);
  EXPECT_EQ(line.session.counters().sessions, 1U) << "without an outage";
  line.run_for(2s);
  EXPECT_EQ(line.session.line_rate_bps(), 500'000U);
}

TEST(SerialRate, StaysWhenRecordsAreDamagedNowAndThen) {
  Line line;
  line.open();
  line.up_fault = spoiling([] { return true; }, 400);  // one record in 20
  std::uint32_t sent = 0;
  line.at_each_step = [&, next = line.now]() mutable {
    if (line.now >= next) {
      line.bridge.hear(numbered(sent++), line.now);
      next += 1ms;
    }
  };
  line.run_for(5s);
  EXPECT_GT(line.session.counters().damaged, 100U);
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
}

}  // namespace
}  // namespace roio::test
