/// Rings: whether joining two buses would join what is joined already, so that a frame went round
/// for ever. Pure functions; claim.hpp asks the system.
#ifndef ROIO_CLI_RINGS_HPP
#define ROIO_CLI_RINGS_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roio::cli {

/// Two buses that are joined, each by a number made from its full name.
struct Joint {
  std::uint64_t first;
  std::uint64_t second;
};

/// Whether there is a way from one bus of `joint` to the other over the others.
bool closes_ring(std::span<const Joint> others, const Joint& joint);

/// The number of a bus. Two names have the same once in 2^64.
std::uint64_t number_of(std::string_view full_name);

/// Under which a joint is known to other programs: the same whichever bus is first.
std::string name_of(const Joint& joint);
std::optional<Joint> parse_joint(std::string_view name);

/// The joints among the lines of /proc/net/unix.
std::vector<Joint> joints_in(std::string_view unix_sockets);

}  // namespace roio::cli

#endif
