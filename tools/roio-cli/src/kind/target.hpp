/// Where a text that was made goes: to standard output or to a file; or it is compared with one.
#ifndef ROIO_CLI_KIND_TARGET_HPP
#define ROIO_CLI_KIND_TARGET_HPP

#include <filesystem>
#include <optional>
#include <string>

namespace roio::cli {

struct Target {
  std::optional<std::filesystem::path> file;  ///< None: standard output.
  bool check = false;                         ///< Writes nothing: is the file what would be made?
};

/// @param source what it was made from; is not written over.
/// @param command what makes it, for who has a stale one: "kind header".
/// @throws Failure: it cannot be written, or with `check`, it is stale or not there.
void deliver(const std::string& text, const Target& target, const std::filesystem::path& source,
             const std::string& command);

}  // namespace roio::cli

#endif
