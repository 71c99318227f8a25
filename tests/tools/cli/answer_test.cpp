// Which messages answer a question.
#include "ask/answer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <roio/filter_socketcan.hpp>
#include <tuple>
#include <vector>

namespace roio::cli {
namespace {

constexpr Timestamp asked{std::chrono::seconds(1'700'000'000)};
constexpr Address us{0, 10};

Message message(Address source, Address destination) {
  return {{Priority::normal, MessageClass::message, destination, source}, 0, {}};
}

Frame frame(const Message& message) {
  Frame frame{};
  EXPECT_EQ(to_frame(message, frame), Status::ok);
  return frame;
}

TEST(Answer, WhichMessagesAreOne) {
  const Address node{0, 2};
  const Address everybody{0, 255};
  const Timeout margin = std::chrono::milliseconds(50);
  const auto us_later = std::chrono::microseconds(1);
  const std::vector<std::tuple<const char*, Address, Message, Timeout, bool>> rows{
      {"from whom was asked", node, message(node, us), us_later, true},
      {"at the very moment", node, message(node, us), Timeout(0), true},
      {"a little before, by another clock", node, message(node, us), -margin, true},
      {"before the question", node, message(node, us), -margin - us_later, false},
      {"from another", node, message({0, 3}, us), us_later, false},
      {"from that node of another subnet", node, message({1, 2}, us), us_later, false},
      {"to another", node, message(node, {0, 11}), us_later, false},
      {"to everybody", node, message(node, {0, 255}), us_later, false},
      {"asked everybody: any", everybody, message({0, 77}, us), us_later, true},
      {"asked everybody: of that subnet", everybody, message({1, 77}, us), us_later, false},
  };
  for (const auto& [what, of, answer, after, expected] : rows) {
    const Message question = message(us, of);
    const Received received{frame(answer), asked + after, 0};
    EXPECT_EQ(is_answer(received, question, asked), expected) << what;
    if (expected) {
      const auto filters = answer_filters(question);
      const std::uint32_t id = tagged_id(received.frame);
      EXPECT_TRUE(std::any_of(filters.begin(), filters.end(),
                              [&](const SocketCanFilter& filter) {
                                return (id & filter.can_mask) == (filter.can_id & filter.can_mask);
                              }))
          << what << ": the bus lets it through";
    }
  }
}

TEST(Answer, UrgentAndOtherClassesAreAnswersTooAndOtherFramesAreNone) {
  const Message question = message(us, {0, 2});
  Message answer = message({0, 2}, us);
  answer.header.priority = Priority::urgent;
  answer.header.message_class = MessageClass::system;
  Frame one = frame(answer);
  EXPECT_TRUE(is_answer({one, asked, 0}, question, asked));
  one.kind = FrameKind::extended_remote;
  EXPECT_FALSE(is_answer({one, asked, 0}, question, asked));
}

}  // namespace
}  // namespace roio::cli
