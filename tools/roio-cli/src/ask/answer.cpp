#include "ask/answer.hpp"

#include <roio/text.hpp>
#include <string>

#include "listen/filter_words.hpp"

namespace roio::cli {
namespace {

// Stamps are another clock's, such as a bridge's, which is not exactly ours. The bus is opened for
// sending alone, and lets in nothing before its filters are set, just before the question: so
// little is old.
constexpr Timeout stamp_margin = std::chrono::milliseconds(50);

}  // namespace

std::vector<SocketCanFilter> answer_filters(const Message& question) {
  const Address asked = question.header.destination;
  const std::string from =
      is_broadcast(asked) ? std::to_string(asked.subnet) + ".any" : to_string(asked);
  const std::vector<std::string> words{"from=" + from, "to=" + to_string(question.header.source)};
  return *compile_filter_words(words);
}

bool is_answer(const Received& received, const Message& question, Timestamp asked) {
  Message message{};
  if (received.time + stamp_margin < asked || to_message(received.frame, message) != Status::ok) {
    return false;
  }
  const Address of = question.header.destination;
  const Address from = message.header.source;
  return message.header.destination == question.header.source && from.subnet == of.subnet &&
         (is_broadcast(of) || from.node == of.node);
}

}  // namespace roio::cli
