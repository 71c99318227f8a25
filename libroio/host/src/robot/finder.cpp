#include <roio/robot.hpp>
#include <system_error>

#include "robot/document.hpp"
#include "robot/file.hpp"

namespace roio {
namespace {

constexpr const char* file_name = "robot.json";

/// An object with the field "roio". What is no JSON may be meant as one: when it has that word in
/// quotes it is taken, so that reading it says what is wrong. So is a file that cannot be read.
bool is_ours(const std::filesystem::path& file) {
  const Parsed<std::string> text = robot_file::read_file(file);
  if (!text) {
    std::error_code not_there;
    return std::filesystem::is_regular_file(file, not_there);
  }
  try {
    const robot_file::Value document =
        robot_file::read_document(robot_file::Source(*text, file_name));
    bool is_there = false;
    for (const robot_file::Value& child : document.children) {
      is_there = is_there || child.name == "roio";
    }
    return is_there;
  } catch (const robot_file::Refused&) {
    return text->find("\"roio\"") != std::string::npos;
  }
}

}  // namespace

std::optional<std::filesystem::path> find_robot_file(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path at = std::filesystem::absolute(folder, error).lexically_normal();
  if (error) {
    return std::nullopt;
  }
  if (!at.has_filename() && at.has_relative_path()) {
    at = at.parent_path();  // "/a/" is "/a"
  }
  for (;;) {
    const std::filesystem::path file = at / file_name;
    if (is_ours(file)) {
      return file;
    }
    if (!at.has_relative_path()) {
      return std::nullopt;
    }
    at = at.parent_path();
  }
}

}  // namespace roio
