/// Whether two texts name one bus, which a command is not to open twice. Pure functions.
#ifndef ROIO_CLI_ONE_BUS_HPP
#define ROIO_CLI_ONE_BUS_HPP

#include <span>
#include <string>

namespace roio::cli {

/// "can0" and "socketcan:can0" are one, as are "local:x" and "local:x?bitrate=500000".
/// @param one a bus as open() takes it, as is `other`.
bool is_one_bus(const std::string& one, const std::string& other);

/// @return the first of them that is this bus, or nullptr.
const std::string* find_bus(std::span<const std::string> buses, const std::string& bus);

}  // namespace roio::cli

#endif
