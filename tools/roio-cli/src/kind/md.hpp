/// A kind as a page for people.
#ifndef ROIO_CLI_KIND_MD_HPP
#define ROIO_CLI_KIND_MD_HPP

#include <roio/kind.hpp>
#include <string>
#include <string_view>

namespace roio::cli {

/// Markdown: a table of its bytes for each message, and of the settings.
/// @param source the kind's file, for the first line.
std::string kind_md(const Kind& kind, std::string_view source);

}  // namespace roio::cli

#endif
