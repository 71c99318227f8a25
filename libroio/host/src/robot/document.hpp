#ifndef ROIO_ROBOT_DOCUMENT_HPP
#define ROIO_ROBOT_DOCUMENT_HPP

#include <string>
#include <string_view>

#include "robot/source.hpp"
#include "robot/value.hpp"

namespace roio::robot_file {

/// Reads a JSON document.
/// @throws Refused for what check_text() refuses; what is no JSON; too deep; a name that an object
///         has twice; a number past a double.
Value read_document(const Source& source);

/// A place in a place: "hears" and "angles" are hears.angles. A name that is none is quoted.
std::string place_in(std::string_view place, std::string_view name);

}  // namespace roio::robot_file

#endif
