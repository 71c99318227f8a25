/// Roio over JSON with names: what roio/json.hpp reads and writes, and beside that what a robot
/// calls it. Target roio::robot.
///
///   {"type":"Roio","to":"arm","message":"angles","fields":{"shoulder":90,"elbow":45,"hand":0}}
///
/// `to` and `from` are places or SUBNET.NODE, `fields` a number, a choice's name or an array of
/// bytes each; `priority` and `timestamp` as without names. Where a message has `data`, that and
/// the addresses beside it are the message, and names are for who reads it.
/// Source: docs/robot-file.md "JSON with names".
#ifndef ROIO_ROBOT_JSON_HPP
#define ROIO_ROBOT_JSON_HPP

#include <roio/export.hpp>
#include <roio/json.hpp>
#include <roio/robot.hpp>
#include <string>
#include <string_view>

namespace roio {

/// Decodes one message, with names or without; with names, of up to 16,384 bytes.
/// @param default_source who sends what has no `from`: what a message is called may hang on that.
///        JsonMessage::has_source stays false. None: nobody.
/// @return errors as of the other parse_json(), of Robot::message(), of pack() and of
///         Robot::objection().
ROIO_EXPORT Parsed<JsonMessage> parse_json(std::string_view text, const Robot& robot,
                                           Address default_source = broadcast_of(0));

/// Encodes one message on one line: as without a robot, then `from` and `to` where places are, and
/// `message` and `fields` where it has a meaning. A value out of range is written as it came, a
/// choice without a name as its number.
ROIO_EXPORT std::string to_json(const JsonMessage& message, const Robot& robot);

}  // namespace roio

#endif
