/// `--robot`, which every command takes that takes an address, and the words that may be names
/// then.
#ifndef ROIO_CLI_NAMES_OPTION_HPP
#define ROIO_CLI_NAMES_OPTION_HPP

#include <CLI/CLI.hpp>
#include <memory>
#include <roio/robot.hpp>
#include <string>

namespace roio::cli {

class RobotOption {
 public:
  explicit RobotOption(CLI::App& command);
  RobotOption(const RobotOption&) = delete;
  RobotOption& operator=(const RobotOption&) = delete;
  ~RobotOption() = default;

  /// See find_robot(). @throws UsageError
  [[nodiscard]] std::shared_ptr<const Robot> find() const;

 private:
  std::string text_;
  CLI::Option* option_;
};

/// BUS, which may be left out where the robot names one.
/// @param robot null: there is none. @param text empty: it is left out.
/// @throws UsageError: there is none; what is wrong with it.
std::string parse_bus_or_robots(const Robot* robot, const std::string& text,
                                const std::string& command);

/// The address of a destination: SUBNET.NODE, SUBNET.* or a place of the robot's.
/// @param robot null: there is none. @throws UsageError
Address parse_destination(const Robot* robot, const std::string& text);
/// The same of who sends: no broadcast address.
Address parse_sender(const Robot* robot, const std::string& text, const char* option);

}  // namespace roio::cli

#endif
