#include "target.hpp"

namespace roio::fuzz {

void check(std::string_view text) {
  const auto source = parse_source(text);
  if (!source) {
    require_good_error(source.error(), text);
  }
  const auto address = parse_address(text);
  if (!address) {
    require_good_error(address.error(), text);
    require(!source, "what is no address is no source");
    return;
  }
  require(is_valid_destination(*address), "an address read is one that can be sent to");
  require(source.ok() == is_valid_source(*address), "a source is an address of one node");
  const auto again = parse_address(to_string(*address));
  require(again && *again == *address, "an address comes back");
}

}  // namespace roio::fuzz
