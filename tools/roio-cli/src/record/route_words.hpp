/// Where the frames of a log go: the words BUS and BUS=NAME, as canplayer has them. Pure functions.
#ifndef ROIO_CLI_ROUTE_WORDS_HPP
#define ROIO_CLI_ROUTE_WORDS_HPP

#include <map>
#include <optional>
#include <roio/text.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roio::cli {

struct Routes {
  std::vector<std::string> buses;                  ///< Each once.
  std::map<std::string, std::size_t> bus_of{};     ///< A log's interface; what of buses it goes to.
  std::optional<std::size_t> bus_of_all_others{};  ///< None: their frames are passed over.
};

/// "vcan0=can0": what the log has of can0 goes to vcan0. "vcan0": all else goes there.
/// @return an error: not a bus, no word, one that contradicts another.
Parsed<Routes> parse_routes(std::span<const std::string> words);

}  // namespace roio::cli

#endif
