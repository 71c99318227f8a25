// Requests: one under way at a time, repeated so often and no more, and each told its outcome once.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "serial/requests.hpp"

namespace roio::serial {
namespace {

using std::chrono::milliseconds;

class RequestsTest : public testing::Test {
 protected:
  /// One that writes down its outcome: "a answered 0".
  Request request(const std::string& name, Down operation = Down::identify) {
    return {operation, {7}, [this, name](const Reply& reply) {
              outcomes.push_back(text(name, reply));
            }};
  }
  static std::string text(const std::string& name, const Reply& reply) {
    switch (reply.kind) {
      case Reply::Kind::answered:
        return name + " answered " + std::to_string(static_cast<int>(reply.status));
      case Reply::Kind::unanswered:
        return name + " unanswered";
      case Reply::Kind::no_session:
        break;
    }
    return name + " no session";
  }

  Requests requests;
  std::vector<std::string> outcomes;
  Time now = std::chrono::hours(1);
};

TEST_F(RequestsTest, AreAskedOneAtATimeInTheirOrder) {
  requests.queue(request("a"));
  requests.queue(request("b"));
  const auto a = requests.next(now);
  ASSERT_TRUE(a);
  EXPECT_EQ(a->operation, Down::identify);
  EXPECT_EQ(std::vector(a->payload.begin(), a->payload.end()), (std::vector<std::uint8_t>{7}));
  EXPECT_FALSE(requests.next(now)) << "a is under way";
  EXPECT_TRUE(requests.answer(a->number, Status::ok));
  const auto b = requests.next(now);
  ASSERT_TRUE(b);
  EXPECT_NE(b->number, a->number);
  EXPECT_TRUE(requests.answer(b->number, Status::no_chip));
  EXPECT_FALSE(requests.next(now));
  EXPECT_EQ(outcomes, (std::vector<std::string>{
                          "a answered 0",
                          "b answered " + std::to_string(static_cast<int>(Status::no_chip))}));
}

TEST_F(RequestsTest, OneThatIsAskedAtOncePassesThoseThatWait) {
  requests.queue(request("waits"));
  const auto question = requests.ask(request("at once", Down::bye), now);
  EXPECT_EQ(question.operation, Down::bye);
  EXPECT_TRUE(requests.answer(question.number, Status::ok));
  EXPECT_EQ(outcomes, (std::vector<std::string>{"at once answered 0"}));
  EXPECT_TRUE(requests.next(now));
}

TEST_F(RequestsTest, IsRepeatedUnderItsNumberAndThenGivenUp) {
  const std::uint8_t number = requests.ask(request("a"), now).number;
  for (unsigned i = 1; i < Requests::max_tries; ++i) {
    EXPECT_EQ(requests.due(), now + milliseconds(100));
    now = requests.due();
    const auto again = requests.repeat(now);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->number, number);
  }
  EXPECT_TRUE(outcomes.empty());
  EXPECT_FALSE(requests.repeat(requests.due()));
  EXPECT_EQ(outcomes, (std::vector<std::string>{"a unanswered"}));
  EXPECT_FALSE(requests.under_way());
  EXPECT_EQ(requests.due(), Time::max());
  EXPECT_EQ(requests.retries(), Requests::max_tries - 1);
}

TEST_F(RequestsTest, WaitAsLongAsTheirOperationTakes) {
  struct Row {
    const char* why;
    Down operation;
    milliseconds interval;
  };
  for (const Row& row : {Row{"the session ends soon", Down::bye, milliseconds(50)},
                         Row{"the controller is started anew", Down::bus, milliseconds(300)},
                         Row{"any other", Down::filter, milliseconds(100)}}) {
    SCOPED_TRACE(row.why);
    const auto question = requests.ask(request("a", row.operation), now);
    EXPECT_EQ(requests.due(), now + row.interval);
    EXPECT_TRUE(requests.answer(question.number, Status::ok));
  }
}

TEST_F(RequestsTest, AnAnswerToAnotherNumberIsNone) {
  EXPECT_FALSE(requests.answer(0, Status::ok)) << "nothing was asked";
  const std::uint8_t number = requests.ask(request("a"), now).number;
  EXPECT_FALSE(requests.answer(static_cast<std::uint8_t>(number - 1), Status::ok));
  EXPECT_TRUE(requests.under_way());
  EXPECT_TRUE(requests.answer(number, Status::ok));
  EXPECT_FALSE(requests.answer(number, Status::ok)) << "it was asked twice, and answered twice";
  EXPECT_EQ(outcomes.size(), 1U);
}

TEST_F(RequestsTest, ANumberTakenElsewhereIsNoRequests) {
  const std::uint8_t taken = requests.take_number();
  EXPECT_NE(requests.ask(request("a"), now).number, taken);
  EXPECT_FALSE(requests.answer(taken, Status::ok));
}

TEST_F(RequestsTest, EndWithTheSessionInTheirOrder) {
  requests.queue(request("a"));
  requests.queue(request("b"));
  requests.queue(request("c"));
  ASSERT_TRUE(requests.next(now));
  requests.end();
  EXPECT_EQ(outcomes, (std::vector<std::string>{"a no session", "b no session", "c no session"}));
  EXPECT_FALSE(requests.next(now));
  EXPECT_EQ(requests.due(), Time::max());
}

TEST_F(RequestsTest, OneMayFollowFromAnother) {
  requests.queue({Down::identify, {}, [this](const Reply&) { requests.queue(request("b")); }});
  const auto a = requests.next(now);
  ASSERT_TRUE(a);
  EXPECT_TRUE(requests.answer(a->number, Status::ok));
  const auto b = requests.next(now);
  ASSERT_TRUE(b);
  EXPECT_TRUE(requests.answer(b->number, Status::ok));
  EXPECT_EQ(outcomes, (std::vector<std::string>{"b answered 0"}));
}

TEST(SerialReply, IsKeptUnlessTheValuesAreWrong) {
  using Kind = Reply::Kind;
  EXPECT_TRUE((Reply{Kind::answered, Status::ok}.is_kept()));
  EXPECT_TRUE((Reply{Kind::answered, Status::no_chip}.is_kept())) << "kept for when there is one";
  EXPECT_FALSE((Reply{Kind::answered, Status::bad_argument}.is_kept()));
  EXPECT_FALSE((Reply{Kind::answered, Status::bad_timing}.is_kept()));
  EXPECT_FALSE((Reply{Kind::unanswered, Status::ok}.is_kept()));
  EXPECT_FALSE((Reply{Kind::no_session, Status::ok}.is_kept()));
}

}  // namespace
}  // namespace roio::serial
