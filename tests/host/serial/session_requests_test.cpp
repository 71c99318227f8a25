// What a program asks of a bridge within a session, and the end that a program makes of one.
#include "line.hpp"

namespace roio::test {
namespace {

TEST(SerialRequests, AreAnsweredAndKept) {
  Line line;
  line.open();
  auto reply = line.reply_of([&](SerialSession::Done done) {
    line.session.set_bus(125'000, BridgeMode::loopback, line.now, std::move(done));
  });
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->ok());
  EXPECT_EQ(line.bridge.bitrate_bps, 125'000U);
  EXPECT_EQ(line.bridge.mode, 2);
  EXPECT_EQ(line.session.info().bitrate_bps, 125'000U);
  reply = line.reply_of([&](SerialSession::Done done) {
    line.session.set_bus(0, BridgeMode::normal, line.now, std::move(done));
  });
  ASSERT_TRUE(reply && reply->ok());
  EXPECT_EQ(line.bridge.bitrate_bps, 125'000U) << "0: as it is";
  reply = line.reply_of([&](SerialSession::Done done) {
    line.session.set_address({3, 255}, line.now, std::move(done));
  });
  ASSERT_TRUE(reply && reply->ok());
  EXPECT_FALSE(line.session.info().address) << "255: no node";
  reply = line.reply_of(
      [&](SerialSession::Done done) { line.session.identify(5, line.now, std::move(done)); });
  ASSERT_TRUE(reply && reply->ok());
  EXPECT_EQ(line.bridge.heard.back().back(), 5);

  line.bridge.reset();
  ASSERT_TRUE(line.run_until([&] { return line.session.counters().sessions == 2; }));
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::ready; }));
  EXPECT_EQ(line.bridge.bitrate_bps, 125'000U);
}

TEST(SerialRequests, AreRepeatedWhenTheReplyIsLost) {
  Line line;
  line.open();
  line.bridge.may_send = losing(serial::Up::reply, 2);
  const auto reply = line.reply_of(
      [&](SerialSession::Done done) { line.session.identify(5, line.now, std::move(done)); });
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->ok());
  EXPECT_EQ(line.session.counters().retries, 2U);
  EXPECT_EQ(line.bridge.count_of(serial::Down::identify), 3);
}

TEST(SerialRequests, EndWithoutAReply) {
  Line line;
  line.open();
  line.bridge.may_send = losing(serial::Up::reply, 1000);
  const auto reply = line.reply_of(
      [&](SerialSession::Done done) { line.session.identify(5, line.now, std::move(done)); }, 1s);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->kind, Reply::Kind::unanswered);
  EXPECT_EQ(line.bridge.count_of(serial::Down::identify), 4);
  EXPECT_EQ(line.session.phase(), Phase::ready);
}

TEST(SerialRequests, EndWithTheSession) {
  Line line;
  line.open();
  line.bridge.is_deaf = true;
  line.run_for(300ms);
  std::vector<Reply> replies;
  for (std::uint8_t i = 0; i < 3; ++i) {
    line.session.identify(i, line.now, [&](const Reply& reply) { replies.push_back(reply); });
  }
  ASSERT_TRUE(line.run_until([&] { return line.session.phase() == Phase::calling; }, 1s));
  ASSERT_EQ(replies.size(), 3U);
  EXPECT_EQ(replies[0].kind, Reply::Kind::no_session);
  EXPECT_EQ(replies[2].kind, Reply::Kind::no_session);
  line.session.identify(9, line.now, [&](const Reply& reply) { replies.push_back(reply); });
  ASSERT_EQ(replies.size(), 4U) << "at once";
}

TEST(SerialRequests, SayWhatTheBridgeSaid) {
  Line line;
  line.open();
  line.bridge.verdict = [](serial::Down) -> std::uint8_t { return 8; };
  const auto reply = line.reply_of([&](SerialSession::Done done) {
    line.session.set_bus(83'333, BridgeMode::normal, line.now, std::move(done));
  });
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->ok());
  EXPECT_EQ(reply->status, Status::bad_timing);
  EXPECT_EQ(line.session.info().bitrate_bps, 500'000U) << "nothing has changed";
}

TEST(SerialRequests, RulesAreKeptWithoutASession) {
  Line line;
  std::optional<Reply> reply;
  line.session.set_rules({{5, 7}}, line.now, [&](const Reply& what) { reply = what; });
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->kind, Reply::Kind::no_session);
  line.open();
  ASSERT_EQ(line.bridge.rules.size(), 1U);
  EXPECT_EQ(line.bridge.rules[0].match, 5U);
}

TEST(SerialRequests, LeaveEndsTheSessionOnBothSides) {
  Line line;
  line.open();
  const auto reply = line.reply_of(
      [&](SerialSession::Done done) { line.session.leave(line.now, std::move(done)); });
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->ok());
  EXPECT_EQ(line.session.phase(), Phase::closed);
  EXPECT_EQ(line.bridge.session(), 0U);
  EXPECT_EQ(line.bridge.rate_bps, 115'200U);
}

TEST(SerialRequests, LeaveEndsASessionWhoseBridgeDoesNotAnswer) {
  Line line;
  line.open();
  line.bridge.is_deaf = true;
  const auto reply = line.reply_of(
      [&](SerialSession::Done done) { line.session.leave(line.now, std::move(done)); }, 300ms);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->kind, Reply::Kind::unanswered);
  EXPECT_EQ(line.session.phase(), Phase::closed);
}

}  // namespace
}  // namespace roio::test
