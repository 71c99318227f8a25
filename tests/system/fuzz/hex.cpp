#include <algorithm>

#include "target.hpp"

namespace roio::fuzz {

void check(std::string_view text) {
  const auto bytes = parse_hex(text);
  if (!bytes) {
    require_good_error(bytes.error(), text);
    return;
  }
  require(bytes->length <= max_data_length, "at most 8 bytes");
  const auto again = parse_hex(to_hex(bytes->data.data(), bytes->length));
  require(again && again->length == bytes->length && again->data == bytes->data,
          "the bytes come back");
  const auto between =
      static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char character) {
        return character == '.' || character == ' ';
      }));
  require(text.size() == 2 * std::size_t{bytes->length} + between,
          "nothing but digits, dots and spaces was read over");
}

}  // namespace roio::fuzz
