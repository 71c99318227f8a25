#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roio;
  const std::string_view text = fuzz::as_text(data, size);
  const auto source = parse_source(text);
  if (!source) {
    fuzz::require_good_error(source.error(), text);
  }
  const auto address = parse_address(text);
  if (!address) {
    fuzz::require_good_error(address.error(), text);
    fuzz::require(!source, "what is no address is no source");
    return 0;
  }
  fuzz::require(is_valid_destination(*address), "an address read is one that can be sent to");
  fuzz::require(source.ok() == is_valid_source(*address), "a source is an address of one node");
  const auto again = parse_address(to_string(*address));
  fuzz::require(again && *again == *address, "an address comes back");
  return 0;
}
