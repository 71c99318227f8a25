#include "form/origin.hpp"

#include <algorithm>
#include <roio/text.hpp>

namespace roio::cli {
namespace {

// A local bus's name goes without "local:".
std::string name_in_log(const std::string& bus_url) {
  const auto url = parse_bus_url(bus_url);
  return (url ? url->target : bus_url).substr(0, max_origin_name);
}

bool has_name(std::span<const Origin> origins, const std::string& name) {
  return std::any_of(origins.begin(), origins.end(),
                     [&](const Origin& origin) { return origin.log_name == name; });
}

std::string unlike(std::span<const Origin> others, const std::string& name) {
  std::string tried = name;
  for (std::size_t number = 2; has_name(others, tried); ++number) {
    const std::string mark = "~" + std::to_string(number);
    tried = name.substr(0, max_origin_name - mark.size()) + mark;
  }
  return tried;
}

}  // namespace

std::vector<Origin> origins_of(std::span<const std::string> bus_urls) {
  std::vector<Origin> origins;
  for (const std::string& url : bus_urls) {
    origins.push_back({url.substr(0, url.find('?')), unlike(origins, name_in_log(url))});
  }
  return origins;
}

std::string names_of(std::span<const Origin> origins) {
  std::string names;
  for (const Origin& origin : origins) {
    names += (names.empty() ? "" : ", ") + origin.bus;
  }
  return names;
}

std::size_t width_of(std::span<const Origin> origins) {
  std::size_t width = 0;
  for (const Origin& origin : origins) {
    width = std::max(width, origin.log_name.size());
  }
  return width;
}

}  // namespace roio::cli
