/// A robot's names for what is on its bus.
#ifndef ROIO_CLI_NAMES_ROBOT_LABELS_HPP
#define ROIO_CLI_NAMES_ROBOT_LABELS_HPP

#include <memory>
#include <roio/robot.hpp>

#include "form/labels.hpp"

namespace roio::cli {

/// @param robot null: numeric_labels().
/// @param bytes_only places have names, messages do not.
std::shared_ptr<const Labels> labels_of(std::shared_ptr<const Robot> robot,
                                        bool bytes_only = false);

}  // namespace roio::cli

#endif
