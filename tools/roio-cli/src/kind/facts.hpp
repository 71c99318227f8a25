/// What every generator says of messages and fields, in the same words.
#ifndef ROIO_CLI_KIND_FACTS_HPP
#define ROIO_CLI_KIND_FACTS_HPP

#include <roio/kind.hpp>
#include <string>
#include <string_view>

namespace roio::cli {

/// The first line of what is made, without the language's mark of a comment: from what, and how.
/// @param made "kind header". @param source a file; its name alone is told.
std::string origin(std::string_view made, std::string_view source);

/// "u8", "i24", "bits", "enum", "bytes": as the kind's file has it.
std::string type_of(const Field& field);

/// "0 to 180 deg", "-10.5 to 10.5 V"; of a choice "off (0), on (1)"; of bytes "0 to 7 bytes".
std::string range_of(const Field& field);

/// "3 bytes", "1 byte", "1 to 8 bytes".
std::string length_of(const MessageKind& message);
std::string byte_count(std::int64_t smallest, std::int64_t largest);

/// A number on the wire, in the field's unit, without the unit.
std::string in_unit(const Field& field, std::int64_t raw);

/// "1", "1/10".
std::string to_string(const Fraction& scale);

/// All of `text` in one line, as files have them; in a kind that a program has made, control
/// characters are spaces. No space at the end.
std::string one_line(std::string_view text);

}  // namespace roio::cli

#endif
