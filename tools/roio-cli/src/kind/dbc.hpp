/// A robot as a DBC file, for SavvyCAN, cantools and others that decode by identifier.
#ifndef ROIO_CLI_KIND_DBC_HPP
#define ROIO_CLI_KIND_DBC_HPP

#include <cstddef>
#include <roio/robot.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace roio::cli {

struct Dbc {
  std::string text;                ///< In ISO 8859-1, which readers of DBC files take for granted.
  std::vector<std::string> notes;  ///< What a DBC cannot express, a line each.
};

/// A message (BO_) for each identifier on which the robot's messages have names, of normal
/// priority.
/// @param source the robot's file, for the first line.
/// @param most bytes. @throws Failure: there would be more.
Dbc robot_dbc(const Robot& robot, std::string_view source,
              std::size_t most = std::size_t{64} << 20U);

}  // namespace roio::cli

#endif
