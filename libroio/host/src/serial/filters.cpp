#include "serial/filters.hpp"

#include <algorithm>
#include <cstdint>
#include <roio/serial_protocol.hpp>

namespace roio::serial {

std::vector<Rule> Filters::rules() const {
  const bool fits = filters_.size() <= max_rules &&
                    std::ranges::none_of(filters_, [](const SocketCanFilter& one) {
                      return (one.can_id & socketcan::inverted) != 0;
                    });
  if (!fits) {
    return {{0, 0}};
  }
  std::vector<Rule> rules;
  for (const SocketCanFilter& filter : filters_) {
    const std::uint32_t mask = effective_mask(filter);
    rules.push_back({filter.can_id & mask, mask});
  }
  return rules;
}

bool Filters::pass(const Frame& frame) const {
  const std::uint32_t tagged = tagged_id(frame);
  return std::ranges::any_of(
      filters_, [tagged](const SocketCanFilter& filter) { return accepts(filter, tagged); });
}

}  // namespace roio::serial
