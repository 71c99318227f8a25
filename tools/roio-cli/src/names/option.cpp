#include "names/option.hpp"

#include <optional>
#include <roio/text.hpp>

#include "names/robot.hpp"
#include "program/words.hpp"

namespace roio::cli {

RobotOption::RobotOption(CLI::App& command)
    : option_(option(command, "--robot", text_, "FILE",
                     "Names from this robot file (default: $ROIO_ROBOT, robot.json around here)")) {
}

std::shared_ptr<const Robot> RobotOption::find() const {
  return find_robot(option_->count() > 0 ? std::optional(text_) : std::nullopt);
}

Address parse_destination(const Robot* robot, const std::string& text) {
  return value_or_refuse(robot != nullptr ? robot->address_of(text) : parse_address(text));
}

Address parse_sender(const Robot* robot, const std::string& text, const char* option) {
  const Place* const place = robot != nullptr ? robot->find(text) : nullptr;
  return place != nullptr ? place->address : value_or_refuse(parse_source(text), option);
}

}  // namespace roio::cli
