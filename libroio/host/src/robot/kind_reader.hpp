#ifndef ROIO_ROBOT_KIND_READER_HPP
#define ROIO_ROBOT_KIND_READER_HPP

#include <optional>
#include <roio/kind.hpp>
#include <string>

#include "robot/source.hpp"

namespace roio::robot_file {

inline constexpr const char* kind_suffix = ".kind.json";

/// Reads a kind. @param name what it must be called, since its file is. @throws Refused
Kind read_kind(const Source& source, const std::optional<std::string>& name);

}  // namespace roio::robot_file

#endif
