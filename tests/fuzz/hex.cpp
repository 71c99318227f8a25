#include <algorithm>

#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roio;
  const std::string_view text = fuzz::as_text(data, size);
  const auto bytes = parse_hex(text);
  if (!bytes) {
    fuzz::require_good_error(bytes.error(), text);
    return 0;
  }
  fuzz::require(bytes->length <= max_data_length, "at most 8 bytes");
  const auto again = parse_hex(to_hex(bytes->data.data(), bytes->length));
  fuzz::require(again && again->length == bytes->length && again->data == bytes->data,
                "the bytes come back");
  const auto dots = static_cast<std::size_t>(std::count(text.begin(), text.end(), '.'));
  fuzz::require(text.size() == 2 * std::size_t{bytes->length} + dots,
                "nothing but digits and dots was read over");
  return 0;
}
