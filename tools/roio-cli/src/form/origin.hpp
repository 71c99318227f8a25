/// How the forms name the buses that frames come from.
#ifndef ROIO_CLI_ORIGIN_HPP
#define ROIO_CLI_ORIGIN_HPP

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace roio::cli {

struct Origin {
  std::string bus;       ///< As the user named it, without options: "can0", "local:robot".
  std::string log_name;  ///< As a log names it: "can0", "robot"; 1..15 bytes, each another.
};

/// The longest name of an interface, which readers of logs have room for.
inline constexpr std::size_t max_origin_name = 15;

/// One for each bus, in their order. Where two would have the same name in a log, the later one's
/// ends with "~2", "~3" and so on.
std::vector<Origin> origins_of(std::span<const std::string> bus_urls);

/// "can0, local:robot".
std::string names_of(std::span<const Origin> origins);

/// How wide a column of their names is.
std::size_t width_of(std::span<const Origin> origins);

}  // namespace roio::cli

#endif
