#include <algorithm>
#include <roio/json.hpp>

#include "target.hpp"

namespace {

bool same(const roio::JsonMessage& a, const roio::JsonMessage& b) {
  return a.message.header == b.message.header && a.message.length == b.message.length &&
         std::equal(a.message.data, a.message.data + roio::max_data_length, b.message.data) &&
         a.has_source == b.has_source && a.time.has_value() == b.time.has_value();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roio;
  const std::string_view text = fuzz::as_text(data, size);
  const auto message = parse_json(text);
  if (!message) {
    fuzz::require_good_error(message.error(), text);
    return 0;
  }
  Frame frame{};
  fuzz::require(to_frame(message->message, frame) == Status::ok,
                "a message read is one that can be sent");
  const auto again = parse_json(to_json(*message));
  fuzz::require(again && same(*again, *message), "a message comes back");
  fuzz::require(!message->time ||
                    *again->time == std::chrono::floor<std::chrono::microseconds>(*message->time),
                "its time comes back to the microsecond");
  return 0;
}
