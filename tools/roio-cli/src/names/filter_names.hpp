/// The words of a filter with a robot's names.
#ifndef ROIO_CLI_NAMES_FILTER_NAMES_HPP
#define ROIO_CLI_NAMES_FILTER_NAMES_HPP

#include <roio/robot.hpp>
#include <string>
#include <vector>

namespace roio::cli {

/// The words with to=PLACE and from=PLACE as to=SUBNET.NODE and from=SUBNET.NODE.
/// @param robot null: there is none, and they stay as they are.
/// @throws UsageError: a word that is no address names no place.
std::vector<std::string> with_addresses(const Robot* robot, std::vector<std::string> words);

}  // namespace roio::cli

#endif
