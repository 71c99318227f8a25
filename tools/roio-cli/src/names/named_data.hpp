/// The words of a message by its names: MESSAGE [FIELD=VALUE...]. Pure functions.
#ifndef ROIO_CLI_NAMES_NAMED_DATA_HPP
#define ROIO_CLI_NAMES_NAMED_DATA_HPP

#include <optional>
#include <roio/robot.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>

namespace roio::cli {

/// The data that the words say, by what the message is called on its way. A word that is both the
/// name of a message and hexadecimal digits is the name.
/// @param words DATA of the command line.
/// @return none: the first word names no message, and is meant as bytes. An error: the message is
///         named, and its fields are not as they should be; or the word is neither, and these are
///         the messages there are.
Parsed<std::optional<Bytes>> parse_named_data(const Robot& robot, Address source,
                                              Address destination,
                                              std::span<const std::string> words);

}  // namespace roio::cli

#endif
