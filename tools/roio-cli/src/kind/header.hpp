/// A kind as a C++11 header for sketches and for the PC.
#ifndef ROIO_CLI_KIND_HEADER_HPP
#define ROIO_CLI_KIND_HEADER_HPP

#include <roio/kind.hpp>
#include <string>
#include <string_view>

namespace roio::cli {

/// A struct with pack() and unpack() for each message. It needs <stdint.h> alone.
/// @param source the kind's file, for the first line.
std::string kind_header(const Kind& kind, std::string_view source);

}  // namespace roio::cli

#endif
