#include <algorithm>
#include <roio/kind.hpp>
#include <vector>

#include "target.hpp"

namespace roio::fuzz {
namespace {

/// The least that each field holds, as text and as it is typed.
void check_values(const MessageKind& message) {
  std::vector<std::uint8_t> data(message.min_length, 0);
  if (message.tag) {
    data[0] = *message.tag;
  }
  require(message.fits(data), "a message of the least length is one of its kind");
  const auto readings = unpack(message, data);
  require(readings.size() == message.fields.size(), "each field is read");
  std::vector<NamedValue> values;
  for (const Reading& reading : readings) {
    const auto value = parse_value(*reading.field, reading.text());
    require(value.ok() || !reading.is_valid(), "what is valid can be typed");
    if (reading.is_valid()) {
      values.push_back({reading.field->name, *value});
    }
  }
  if (values.size() == readings.size()) {
    const auto bytes = pack(message, values);
    require(bytes && bytes->length == data.size() &&
                std::equal(data.begin(), data.end(), bytes->data.begin()),
            "bytes come back");
  }
}

void check_messages(const std::vector<MessageKind>& messages) {
  for (const MessageKind& message : messages) {
    require(message.min_length <= message.max_length && message.max_length <= max_data_length,
            "a message fits into a frame");
    for (const Field& field : message.fields) {
      require(field.first_bit + field.width <= 8 * message.max_length, "a field is in its message");
      require(field.minimum <= field.maximum, "a field holds something");
    }
    check_values(message);
  }
}

}  // namespace

void check(std::string_view text) {
  const auto kind = parse_kind(text, "fuzz.kind.json");
  if (!kind) {
    require_good_error(kind.error(), text);
    return;
  }
  check_messages(kind->heard);
  check_messages(kind->said);
}

}  // namespace roio::fuzz
