#include <roio/robot.hpp>
#include <set>
#include <string>

#include "robot/robot_reader.hpp"
#include "target.hpp"

namespace roio::fuzz {
namespace {

/// Each place is found by its name and its address, and hears what its kind says that it does.
void check_place(const Robot& robot, const Place& place) {
  require(robot.find(place.name) == &place && robot.find(place.address) == &place,
          "a place is found");
  const auto address = robot.address_of(place.name);
  require(address && *address == place.address, "its name is an address");
  if (place.kind == nullptr) {
    return;
  }
  for (const MessageKind& message : place.kind->heard) {
    const auto found = robot.message({31, 254}, place.address, message.name);
    require(robot.find(Address{31, 254}) != nullptr || (found && *found == &message),
            "what it hears is found");
  }
}

}  // namespace

void check(std::string_view text) {
  const LoadOptions options{{ROIO_SOURCE_DIR "/kinds", ROIO_SOURCE_DIR "/tests/host/robot/valid"}};
  const auto robot = robot_file::parse_robot(text, "/nowhere/robot.json", options);
  if (!robot) {
    require_good_error(robot.error(), text);
    return;
  }
  std::set<std::string> names;
  for (const Place& place : robot->places) {
    require(names.insert(place.name).second, "no two places have a name");
    check_place(*robot, place);
  }
}

}  // namespace roio::fuzz
