/// Which robot's names hold for a command.
#ifndef ROIO_CLI_NAMES_ROBOT_HPP
#define ROIO_CLI_NAMES_ROBOT_HPP

#include <memory>
#include <optional>
#include <roio/robot.hpp>
#include <string>

namespace roio::cli {

/// The robot of `--robot FILE`, else of ROIO_ROBOT, else of the robot.json in this folder or the
/// nearest one above. "none", and an empty ROIO_ROBOT, is none, whatever lies around.
/// @param option what `--robot` says; none: it is not there.
/// @return null: there is none, and addresses are numbers.
/// @throws UsageError: the file cannot be read, or what is wrong in it; or this roio-cli was built
///         without JSON, and a file was named.
std::shared_ptr<const Robot> find_robot(const std::optional<std::string>& option);

/// Where every command looks for kinds: beside the program, too.
LoadOptions load_options();

/// A place of the robot's, SUBNET.NODE or SUBNET.*. @param robot null: there is none.
Parsed<Address> address_of(const Robot* robot, const std::string& text);

/// The robot's bus as open() takes it, with its bit rate where the kind of bus takes one and its
/// name has none; empty: the robot names no bus.
std::string bus_of(const Robot& robot);

}  // namespace roio::cli

#endif
