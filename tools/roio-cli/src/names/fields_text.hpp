/// A message's fields as a line for people: "shoulder=90 deg  elbow=45 deg". Pure functions.
#ifndef ROIO_CLI_NAMES_FIELDS_TEXT_HPP
#define ROIO_CLI_NAMES_FIELDS_TEXT_HPP

#include <roio/robot.hpp>

#include "form/frame_text.hpp"

namespace roio::cli {

/// Appends the fields, two spaces between them. A value that the kind does not allow has what was
/// expected behind it. Nothing for a message without fields.
void append_fields(Buffer& out, const NamedMessage& message);

}  // namespace roio::cli

#endif
