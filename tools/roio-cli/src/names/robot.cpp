#include "names/robot.hpp"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "program/exit_status.hpp"
#include "program/share.hpp"

namespace roio::cli {
namespace {

constexpr const char* no_robot = "none";

/// @return none: nobody said; empty: none is wanted.
std::optional<std::filesystem::path> named_file(const std::optional<std::string>& option) {
  if (option) {
    return *option;
  }
  const char* const variable = std::getenv("ROIO_ROBOT");
  return variable != nullptr ? std::optional<std::filesystem::path>(variable) : std::nullopt;
}

}  // namespace

std::shared_ptr<const Robot> find_robot(const std::optional<std::string>& option) {
  std::error_code no_folder;
  std::optional<std::filesystem::path> file = named_file(option);
  if (!file) {
    file = find_robot_file(std::filesystem::current_path(no_folder));
  }
  if (!file || file->empty() || *file == no_robot) {
    return nullptr;
  }
  auto robot = load_robot(*file, load_options());
  if (!robot) {
    throw UsageError(robot.error().message);
  }
  return std::make_shared<const Robot>(*robot);
}

LoadOptions load_options() {
  return {{share_folder() / "kinds"}};
}

Parsed<Address> address_of(const Robot* robot, const std::string& text) {
  return robot != nullptr ? robot->address_of(text) : parse_address(text);
}

std::string bus_of(const Robot& robot) {
  const bool has_options = robot.bus.find('?') != std::string::npos;
  const auto url = parse_bus_url(robot.bus);
  const bool takes_rate = url && url->kind != BusUrl::Kind::socketcan;
  return robot.bitrate && takes_rate && !url->bitrate
             ? robot.bus + (has_options ? '&' : '?') + "bitrate=" + std::to_string(*robot.bitrate)
             : robot.bus;
}

}  // namespace roio::cli
