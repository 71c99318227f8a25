/// Roio over JSON: the messages of 2014 as they were, with optional additions. A pure codec, target
/// roio::json. Source: docs/protocol.md "JSON".
///
///   {"type":"Roio","isBroadcast":false,"address":25,"subnet":10,"messageLength":4,"data":[10,20,30,40]}
///
/// Always there: type "Roio", isBroadcast, subnet 0..31, messageLength 0..8, data (as many integers
/// 0..255), and address 0..254 unless isBroadcast (where it may be 255 or left out).
/// Optional: priority "urgent" | "normal" (the default), source "SUBNET.NODE", destination the same
/// (must agree with subnet and address), timestamp (seconds since 1970, a number), class "message"
/// (the default) | "system" | "stream".
#ifndef ROIO_JSON_HPP
#define ROIO_JSON_HPP

#include <optional>
#include <string>
#include <string_view>

#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/message.hpp>
#include <roio/text.hpp>

namespace roio {

struct JsonMessage {
  Message message{};
  bool has_source = false;  ///< Whether message.header.source was given.
  std::optional<Timestamp> time;
};

/// Decodes one message. Unknown fields are errors, so a slip of the pen is seen.
/// Refused with the field's name and what was expected there: missing, of the wrong type, out of
/// range, not an integer, contradicting another, given twice; texts above 4,096 bytes, nested
/// deeper than the format ever is, not UTF-8, or with a zero byte or a byte order mark. A subnet
/// "server" and an address that is a name, which the original has between software modules, are
/// refused as such. ParseError::offset is that of a syntax error; where the field is named, it is
/// 0. Throws nothing but std::bad_alloc. Fractions of a timestamp are taken to the nanosecond.
ROIO_EXPORT Parsed<JsonMessage> parse_json(std::string_view text);

/// Encodes one message on one line, no line end: the original's fields in the original's order,
/// then priority when urgent, class when not message, source when has_source, timestamp when there
/// is one. The address is left out of a broadcast. A timestamp has microseconds: what is below is
/// cut off, and a time before 1970 becomes 0.
/// @param message one that to_frame() takes (its source, when it has one, too).
ROIO_EXPORT std::string to_json(const JsonMessage& message);

}  // namespace roio

#endif
