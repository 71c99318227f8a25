#include "program/one_bus.hpp"

#include <algorithm>
#include <roio/text.hpp>

namespace roio::cli {

bool is_one_bus(const std::string& one, const std::string& other) {
  const auto one_url = parse_bus_url(one);
  const auto other_url = parse_bus_url(other);
  return one_url && other_url && one_url->kind == other_url->kind &&
         one_url->target == other_url->target;
}

const std::string* find_bus(std::span<const std::string> buses, const std::string& bus) {
  const auto found = std::find_if(buses.begin(), buses.end(),
                                  [&](const std::string& one) { return is_one_bus(one, bus); });
  return found != buses.end() ? &*found : nullptr;
}

}  // namespace roio::cli
