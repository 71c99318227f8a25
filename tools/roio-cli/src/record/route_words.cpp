#include "record/route_words.hpp"

#include <algorithm>

#include "program/one_bus.hpp"

namespace roio::cli {
namespace {

struct Route {
  std::string bus;
  std::optional<std::string> interface_name;
};

// A bus may have an equals sign in it: "local:robot?bitrate=500000" is one, and so is what stands
// before the last of "local:robot?bitrate=500000=can0".
Route parse_route(const std::string& word) {
  const std::size_t sign = word.rfind('=');
  if (sign == std::string::npos || !parse_bus_url(word.substr(0, sign))) {
    return {word, std::nullopt};
  }
  return {word.substr(0, sign), word.substr(sign + 1)};
}

std::size_t number_of(const std::string& bus, std::vector<std::string>& buses) {
  const auto found = std::find(buses.begin(), buses.end(), bus);
  const auto number = static_cast<std::size_t>(found - buses.begin());
  if (found == buses.end()) {
    buses.push_back(bus);
  }
  return number;
}

ParseError refused(const std::string& word, const std::string& why) {
  return {"BUS " + quote(word) + ": " + why, 0};
}

std::optional<ParseError> add_route(Routes& routes, const std::string& word) {
  const Route route = parse_route(word);
  if (const auto url = parse_bus_url(route.bus); !url) {
    return url.error();
  }
  const std::string* const other = find_bus(routes.buses, route.bus);
  if (other != nullptr && *other != route.bus) {
    return refused(word, "the same as " + quote(*other) + "; expected one name of it");
  }
  const std::size_t number = number_of(route.bus, routes.buses);
  if (!route.interface_name) {
    if (routes.bus_of_all_others) {
      return refused(word, "expected one BUS, or BUS=NAME for each interface of the log");
    }
    routes.bus_of_all_others = number;
    return std::nullopt;
  }
  if (route.interface_name->empty()) {
    return refused(word, "expected the name of an interface in the log after '='");
  }
  if (!routes.bus_of.emplace(*route.interface_name, number).second) {
    return refused(word, quote(*route.interface_name) + " goes to another bus already");
  }
  return std::nullopt;
}

}  // namespace

Parsed<Routes> parse_routes(std::span<const std::string> words) {
  Routes routes;
  for (const std::string& word : words) {
    if (const auto error = add_route(routes, word)) {
      return *error;
    }
  }
  return routes;
}

}  // namespace roio::cli
