/// ISO 8859-1, in which DBC files are read.
#ifndef ROIO_CLI_KIND_LATIN1_HPP
#define ROIO_CLI_KIND_LATIN1_HPP

#include <cstddef>
#include <string>
#include <string_view>

namespace roio::cli {

struct Latin1 {
  std::string text;
  std::size_t replaced = 0;  ///< Characters that it does not have; each is a '?'.
};

/// @param text UTF-8, well-formed.
Latin1 to_latin1(std::string_view text);

}  // namespace roio::cli

#endif
