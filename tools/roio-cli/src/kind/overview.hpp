/// What a robot has, for people.
#ifndef ROIO_CLI_KIND_OVERVIEW_HPP
#define ROIO_CLI_KIND_OVERVIEW_HPP

#include <roio/robot.hpp>
#include <string>

namespace roio::cli {

/// Its places, a line each, and what each kind hears and says.
std::string overview(const Robot& robot);

}  // namespace roio::cli

#endif
