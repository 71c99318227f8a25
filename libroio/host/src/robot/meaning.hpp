#ifndef ROIO_ROBOT_MEANING_HPP
#define ROIO_ROBOT_MEANING_HPP

#include <roio/robot.hpp>

namespace roio::robot_file {

/// What a message of a name is, on its way. Source: docs/robot-file.md "What a message means".
/// @param sender null: none that has a kind.
/// @return an error says which messages there are.
Parsed<const MessageKind*> find_message(const Robot& robot, const Place* sender,
                                        Address destination, std::string_view name);

/// What these bytes are called on their way. @return null: by nobody, or not the same by all.
const MessageKind* find_meaning(const Robot& robot, const Header& header,
                                std::span<const std::uint8_t> data) noexcept;

}  // namespace roio::robot_file

#endif
