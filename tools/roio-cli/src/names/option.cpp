#include "names/option.hpp"

#include <optional>
#include <roio/text.hpp>

#include "names/robot.hpp"
#include "program/words.hpp"

namespace roio::cli {

RobotOption::RobotOption(CLI::App& command)
    : option_(option(command, "--robot", text_, "FILE",
                     "Robot file with the names (or none); see below")) {}

std::shared_ptr<const Robot> RobotOption::find() const {
  return find_robot(option_->count() > 0 ? std::optional(text_) : std::nullopt);
}

std::string parse_bus_or_robots(const Robot* robot, const std::string& text,
                                const std::string& command) {
  const std::string bus = text.empty() && robot != nullptr ? bus_of(*robot) : text;
  if (bus.empty()) {
    refuse(command, "expected BUS");
  }
  return parse_bus(bus);
}

Address parse_destination(const Robot* robot, const std::string& text) {
  return value_or_refuse(address_of(robot, text));
}

Address parse_sender(const Robot* robot, const std::string& text, const char* option) {
  const Address address = value_or_refuse(address_of(robot, text), option);
  return is_broadcast(address) ? value_or_refuse(parse_source(text), option) : address;
}

}  // namespace roio::cli
