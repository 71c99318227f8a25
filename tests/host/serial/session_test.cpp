// Sessions: how they come about, what they set up, and how they end.
#include <algorithm>

#include "line.hpp"

namespace roio::test {
namespace {

constexpr std::uint32_t doc_session = 0x52AB0149;

TEST(SerialSession, SaysHelloAsTheDocumentHasItEvery50Milliseconds) {
  SerialSession session({}, [] { return doc_session; });
  const Bytes expected{0x00,  // ends what was before
                       0x02, 0xE1, 0x0A, 0x02, 0x52, 0xAB, 0x01,
                       0x49, 0x73, 0xF2, 0x4F, 0x7E, 0x00};
  session.begin(1s);
  for (Time now = 1s; now < 2s; now += 50ms) {
    session.on_time(now - 1ns);
    EXPECT_EQ(Bytes(session.output().begin(), session.output().end()), expected);
    session.consume_output(session.output().size());
    EXPECT_EQ(session.deadline(), now + 50ms);
    session.on_time(session.deadline());
  }
  EXPECT_EQ(session.line_rate_bps(), 115'200U);
}

// Its program-page command is 0x64, and it erases before it has looked at what follows.
TEST(SerialSession, SaysNothingThatABootLoaderTakesForACommand) {
  std::vector<std::uint32_t> nonces{0, 0x64, 0x00006400, 0x64640000, doc_session};
  SerialSession session({}, [&nonces] {
    const std::uint32_t first = nonces.front();
    nonces.erase(nonces.begin());
    return first;
  });
  session.begin(1s);
  EXPECT_TRUE(nonces.empty()) << "those before are not taken";
  EXPECT_EQ(std::count(session.output().begin(), session.output().end(), 0x64), 0);
}

TEST(SerialSession, OpensAtTheRateWanted) {
  Line line;
  line.open();
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
  EXPECT_EQ(line.bridge.rate_bps, 1'000'000U);
  EXPECT_EQ(line.bridge.count_of(serial::Down::bus), 0) << "it is as it is to be";
  EXPECT_EQ(line.bridge.count_of(serial::Down::filter), 0) << "it may stay as it is";
  const BridgeInfo info = line.session.info();
  EXPECT_EQ(to_string(info.firmware), "0.1.0");
  EXPECT_EQ(info.board, BridgeBoard::uno);
  EXPECT_EQ(info.osc_khz, 16'000);
  EXPECT_EQ(info.bitrate_bps, 500'000U);
  EXPECT_EQ(info.mode, BridgeMode::normal);
  ASSERT_TRUE(info.address);
  EXPECT_EQ(info.address->node, 254);
  EXPECT_TRUE(info.interrupt_wired);
  EXPECT_TRUE(info.line_rate_matters);
  EXPECT_EQ(info.line_rate_bps, 1'000'000U);
  EXPECT_EQ(info.state, BridgeState::active);
  EXPECT_EQ(info.transmit_errors, 5);
  EXPECT_EQ(info.receive_errors, 7);
  EXPECT_EQ(line.session.counter_reports(), 1U);
  EXPECT_EQ(line.session.bridge_counters().dropped, 100U);
  EXPECT_EQ(line.session.bridge_counters().overruns, 110U);
  EXPECT_EQ(line.session.counters().damaged, 0U);
}

struct RateCase {
  const char* why;
  std::uint32_t wanted;
  std::uint8_t rates;
  std::uint8_t flags;
  std::uint32_t expected;
};

TEST(SerialSession, TakesTheBestRateThatBothHave) {
  const RateCase cases[] = {
      {"the base rate needs no asking", 115'200, 0x1F, 1, 115'200},
      {"slow", 250'000, 0x1F, 1, 250'000},
      {"fastest", 2'000'000, 0x1F, 1, 2'000'000},
      {"the bridge has less", 2'000'000, 0x07, 1, 500'000},
      {"the bridge has a gap there", 1'000'000, 0x13, 1, 250'000},
      {"the bridge has none but the base rate", 1'000'000, 0x01, 1, 115'200},
      {"a board whose USB is its own", 1'000'000, 0x1F, 0, 115'200},
  };
  for (const RateCase& row : cases) {
    Line line({.line_rate_bps = row.wanted});
    line.bridge.rates = row.rates;
    line.bridge.flags = row.flags;
    line.open();
    EXPECT_EQ(line.session.line_rate_bps(), row.expected) << row.why;
    EXPECT_EQ(line.bridge.rate_bps, row.expected) << row.why;
  }
}

TEST(SerialSession, OpensThroughGarbage) {
  Line line;
  for (int i = 0; i < 500; ++i) {
    line.bridge.out.push_back({static_cast<std::uint8_t>(i * 37), 115'200});
  }
  line.open();
  EXPECT_EQ(line.session.counters().damaged, 0U) << "before a session, anything may come";
}

TEST(SerialSession, IsSilentAboutABridgeThatStartsLate) {
  Line line;
  line.bridge.is_deaf = true;
  line.session.begin(line.now);
  line.run_for(2s);
  EXPECT_EQ(line.session.phase(), Phase::calling);
  line.bridge.is_deaf = false;
  EXPECT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }, 200ms));
}

TEST(SerialSession, OpensNoneWithAnotherVersion) {
  Line line;
  line.bridge.version = 1;
  line.session.begin(line.now);
  line.run_for(300ms);
  EXPECT_EQ(line.session.phase(), Phase::calling);
  ASSERT_TRUE(line.session.other_version());
  EXPECT_EQ(line.session.other_version()->protocol, 1);
  ASSERT_TRUE(line.session.other_version()->firmware);
  EXPECT_EQ(to_string(*line.session.other_version()->firmware), "0.1.0");
}

TEST(SerialSession, TellsTheBridgeItsSettings) {
  Line line({.bitrate_bps = 125'000,
             .mode = BridgeMode::listen,
             .address = Address{3, 200},
             .rules = std::vector<serial::Rule>{{0x90004000, 0xE3FFE000}, {1, 2}}});
  line.open();
  EXPECT_EQ(line.bridge.bitrate_bps, 125'000U);
  EXPECT_EQ(line.bridge.mode, 1);
  ASSERT_EQ(line.bridge.rules.size(), 2U);
  EXPECT_EQ(line.bridge.rules[0].match, 0x90004000U);
  EXPECT_EQ(line.bridge.rules[0].mask, 0xE3FFE000U);
  EXPECT_EQ(line.bridge.rules[1].match, 1U);
  EXPECT_EQ(line.bridge.count_of(serial::Down::address), 1);
  EXPECT_EQ(line.session.info().bitrate_bps, 125'000U);
  EXPECT_EQ(line.session.info().mode, BridgeMode::listen);

  line.bridge.reset();
  ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions == 2; }));
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }));
  EXPECT_EQ(line.bridge.bitrate_bps, 125'000U) << "and again after a reset";
  EXPECT_EQ(line.bridge.rules.size(), 2U);
}

TEST(SerialSession, RestartsNoControllerThatIsAsItShouldBe) {
  Line line({.bitrate_bps = 500'000, .mode = BridgeMode::normal});
  line.open();
  EXPECT_EQ(line.bridge.count_of(serial::Down::bus), 0);
}

TEST(SerialSession, UsesNoBridgeThatRefusesItsSettings) {
  Line line({.bitrate_bps = 800'000});
  line.bridge.verdict = [](serial::Down operation) -> std::uint8_t {
    return operation == serial::Down::bus ? 8 : 0;
  };
  line.session.begin(line.now);
  ASSERT_TRUE(line.run_until([&] { return line.session.refusal().has_value(); }));
  EXPECT_EQ(*line.session.refusal(), Status::bad_timing);
  EXPECT_EQ(line.session.phase(), Phase::calling);
  const int hellos = line.bridge.hellos;
  line.run_for(900ms);
  EXPECT_EQ(line.bridge.hellos, hellos) << "it is left in peace for a while";
  line.bridge.verdict = nullptr;
  EXPECT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }, 2s));
  EXPECT_FALSE(line.session.refusal());
}

TEST(SerialSession, TakesABridgeWithoutAController) {
  Line line({.bitrate_bps = 250'000});
  line.bridge.state = 4;
  line.bridge.verdict = [](serial::Down operation) -> std::uint8_t {
    return operation == serial::Down::bus ? 6 : 0;
  };
  line.open();
  EXPECT_EQ(line.session.info().state, BridgeState::no_controller);
}

TEST(SerialSession, LearnsTheCrystalOfAControllerThatTurnsUpLater) {
  Line line;
  line.bridge.state = 4;
  line.bridge.osc_khz = 0;
  line.bridge.flags = serial::rate_matters;
  line.open();
  line.run_for(300ms);
  EXPECT_EQ(line.bridge.hellos, 1);
  line.bridge.state = 0;
  line.bridge.osc_khz = 8'000;
  line.bridge.flags |= serial::interrupt_is_wired;
  line.bridge.may_send = losing(serial::Up::welcome);
  ASSERT_TRUE(line.run_until([&] { return line.session.info().osc_khz == 8'000; }, 400ms));
  EXPECT_TRUE(line.session.info().interrupt_wired);
  line.run_for(1s);
  EXPECT_EQ(line.bridge.hellos, 3) << "once more than was lost";
  EXPECT_EQ(line.session.counters().sessions, 1U);
}

struct ResetCase {
  const char* why;
  std::uint32_t bitrate_bps;   // the session's
  bool had_one_before;         // that the bridge has heard of
  std::uint32_t ticks_before;  // the bridge's clock at its reset
};

// Else it would go on with a bridge that has forgotten all that it was told.
TEST(SerialSession, IsLostWhenTheBoardIsResetJustBeforeHelloIsRepeated) {
  constexpr std::uint32_t an_hour = 900'000'000;
  for (const ResetCase& row : {ResetCase{"another bit rate", 125'000, false, 0},
                               ResetCase{"another session before", 500'000, true, 0},
                               ResetCase{"its time goes back", 500'000, false, an_hour}}) {
    SCOPED_TRACE(row.why);
    Line line({.line_rate_bps = 115'200, .bitrate_bps = row.bitrate_bps});
    line.bridge.first_tick = row.ticks_before;
    line.bridge.osc_khz = 0;
    line.bridge.state = 4;
    line.open();
    if (row.had_one_before) {
      line.session.end();
      line.open();
    }
    line.run_for(300ms);
    const std::uint64_t sessions = line.session.counters().sessions;
    const int hellos = line.bridge.hellos;
    // STATUS says that there is a controller; before its last byte has come, the board is reset.
    bool is_told = false;
    line.bridge.may_send = [&](const Bytes& body) {
      is_told = is_told || body[0] == static_cast<std::uint8_t>(serial::Up::status);
      return true;
    };
    line.bridge.state = 0;
    line.at_each_step = [&, done = false]() mutable {
      if (is_told && !done && line.bridge.out.size() == 1) {
        done = true;
        const auto last = line.bridge.out;
        line.bridge.reset();
        line.bridge.first_tick = 0;
        line.bridge.out = last;
      }
    };
    ASSERT_TRUE(line.run_until([&] { return line.bridge.hellos > hellos; }, 200ms));
    ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions > sessions; }, 1s));
    ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }, 1s));
    EXPECT_EQ(line.bridge.bitrate_bps, row.bitrate_bps);
  }
}

TEST(SerialSession, AsksForACrystalThatNobodyKnowsAFewTimesOnly) {
  Line line;
  line.bridge.osc_khz = 0;
  line.open();
  line.run_for(3s);
  EXPECT_EQ(line.bridge.hellos, 5);
  EXPECT_EQ(line.session.phase(), Phase::ready);
}

TEST(SerialSession, PollsTenTimesASecond) {
  Line line;
  line.open();
  const int before = line.bridge.count_of(serial::Down::poll);
  line.run_for(10s);
  EXPECT_NEAR(line.bridge.count_of(serial::Down::poll) - before, 100, 1);
  EXPECT_NEAR(static_cast<double>(line.session.counter_reports()), 11, 1) << "once a second";
  EXPECT_EQ(line.session.counters().sessions, 1U);
}

TEST(SerialSession, AsksForCountersWhenTheStateChanges) {
  Line line;
  line.open();
  line.run_for(300ms);
  const std::uint64_t before = line.session.counter_reports();
  line.bridge.state = 3;
  EXPECT_TRUE(line.run_until([&] { return line.session.counter_reports() == before + 1; }, 210ms));
  EXPECT_EQ(line.session.info().state, BridgeState::bus_off);
}

TEST(SerialSession, IsBackWithinASecondOfAReset) {
  Line line;
  line.open();
  // In the middle of a record.
  line.bridge.send_status(line.now);
  line.bridge.out.resize(line.bridge.out.size() / 2);
  line.run_for(100us);
  line.bridge.reset();
  EXPECT_TRUE(line.run_until([&] { return line.session.phase() == Phase::calling; }, 510ms));
  EXPECT_EQ(line.session.line_rate_bps(), 115'200U);
  EXPECT_EQ(line.session.info().state, BridgeState::absent);
  EXPECT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }, 200ms));
  EXPECT_EQ(line.session.counters().sessions, 2U);
  EXPECT_EQ(line.session.line_rate_bps(), 1'000'000U);
}

TEST(SerialSession, IsBackWithinASecondOfALineThatWasDead) {
  Line line;
  line.open();
  bool dead = true;
  line.up_fault = [&dead](std::uint8_t byte) { return dead ? std::nullopt : std::optional(byte); };
  line.down_fault = line.up_fault;
  line.run_for(700ms);
  dead = false;
  EXPECT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }, 1s));
}

TEST(SerialSession, EndsAndBeginsWithThePort) {
  Line line;
  line.open();
  line.session.end();
  EXPECT_EQ(line.session.phase(), Phase::closed);
  EXPECT_EQ(line.session.deadline(), Time::max());
  EXPECT_TRUE(line.session.output().empty());
  line.run_for(1s);
  EXPECT_EQ(line.session.phase(), Phase::closed);
  line.open();
}

}  // namespace
}  // namespace roio::test
