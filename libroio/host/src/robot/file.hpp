#ifndef ROIO_ROBOT_FILE_HPP
#define ROIO_ROBOT_FILE_HPP

#include <filesystem>
#include <roio/text.hpp>
#include <string>

namespace roio::robot_file {

/// A file's bytes. Never waits: what is no ordinary file is refused.
/// @return an error: "robot.json: No such file or directory", a folder, above max_text bytes.
Parsed<std::string> read_file(const std::filesystem::path& file);

}  // namespace roio::robot_file

#endif
