#ifndef ROIO_ROBOT_ROBOT_READER_HPP
#define ROIO_ROBOT_ROBOT_READER_HPP

#include <filesystem>
#include <roio/robot.hpp>
#include <string_view>

namespace roio::robot_file {

/// Reads a robot's text as load_robot() reads its file. @param file where it would be.
Parsed<Robot> parse_robot(std::string_view text, const std::filesystem::path& file,
                          const LoadOptions& options);

}  // namespace roio::robot_file

#endif
