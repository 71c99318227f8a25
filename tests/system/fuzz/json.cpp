#include <algorithm>
#include <roio/json.hpp>

#include "target.hpp"

namespace roio::fuzz {
namespace {

bool same(const JsonMessage& a, const JsonMessage& b) {
  return a.message.header == b.message.header && a.message.length == b.message.length &&
         std::equal(a.message.data, a.message.data + max_data_length, b.message.data) &&
         a.has_source == b.has_source && a.time.has_value() == b.time.has_value();
}

}  // namespace

void check(std::string_view text) {
  const auto message = parse_json(text);
  if (!message) {
    require_good_error(message.error(), text);
    return;
  }
  Frame frame{};
  require(to_frame(message->message, frame) == Status::ok,
          "a message read is one that can be sent");
  const auto again = parse_json(to_json(*message));
  require(again && same(*again, *message), "a message comes back");
  require(!message->time ||
              *again->time == std::chrono::floor<std::chrono::microseconds>(*message->time),
          "its time comes back to the microsecond");
}

}  // namespace roio::fuzz
