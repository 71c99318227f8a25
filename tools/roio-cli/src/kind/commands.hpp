/// `roio-cli kind` and `roio-cli robot`: what a kind's or a robot's file is made into.
#ifndef ROIO_CLI_KIND_COMMANDS_HPP
#define ROIO_CLI_KIND_COMMANDS_HPP

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "kind/target.hpp"

namespace roio::cli {

struct KindOptions {
  enum class Language : std::uint8_t { header, js, md };
  Language language = Language::header;
  std::filesystem::path file;
  Target target{};
};

struct RobotDbcOptions {
  std::filesystem::path file;
  Target target{};
};

struct RobotCheckOptions {
  std::filesystem::path file;
};

/// A robot of more has no DBC: its messages grow with the square of that.
inline constexpr std::size_t most_dbc_places = 200;

/// @return the exit status. @throws Failure: what is wrong with the file, in one line.
int make_from_kind(const KindOptions& options);
/// The same; what a DBC cannot express is told on standard error.
int make_dbc(const RobotDbcOptions& options);
/// Prints what the robot has.
int check_robot(const RobotCheckOptions& options);

}  // namespace roio::cli

#endif
