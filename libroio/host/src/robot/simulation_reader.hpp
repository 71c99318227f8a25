#ifndef ROIO_ROBOT_SIMULATION_READER_HPP
#define ROIO_ROBOT_SIMULATION_READER_HPP

#include <filesystem>
#include <roio/robot.hpp>

#include "robot/at.hpp"

namespace roio::robot_file {

/// What roio-sim needs of a place. Which pins a board has is for roio-sim to know.
/// @param folder of the robot's file. @throws Refused
SimulatedBoard read_simulation(const At& at, const std::filesystem::path& folder);

}  // namespace roio::robot_file

#endif
