#include "gen/traffic.hpp"

#include <algorithm>

#include "gen/numbered.hpp"

namespace roio::cli {

Frame Traffic::next() {
  const Header header{options_.priority, MessageClass::message,
                      options_.destination ? *options_.destination : any_node(),
                      options_.source ? *options_.source : any_node()};
  Frame frame{};
  frame.kind = FrameKind::extended;
  frame.id = pack_id(header);
  frame.length = static_cast<std::uint8_t>(options_.shortest +
                                           below(options_.longest - options_.shortest + 1U));
  const auto data = write_numbered({options_.id, !options_.source}, number_++, frame.length);
  std::copy(data.begin(), data.end(), frame.data);
  return frame;
}

// The library's distributions differ from one compiler to the next.
std::uint32_t Traffic::below(std::uint32_t limit) {
  return limit <= 1 ? 0 : static_cast<std::uint32_t>(std::uint64_t{random_()} * limit >> 32);
}

Address Traffic::any_node() {
  return {static_cast<std::uint8_t>(below(max_subnet + 1U)),
          static_cast<std::uint8_t>(below(max_node + 1U))};
}

}  // namespace roio::cli
