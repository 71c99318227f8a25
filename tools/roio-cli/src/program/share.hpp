/// Where the files lie that a tool needs beside itself.
#ifndef ROIO_CLI_SHARE_HPP
#define ROIO_CLI_SHARE_HPP

#include <filesystem>

namespace roio::cli {

/// share/roio beside the folder that the program lies in, in an installed tree as in a build tree.
inline std::filesystem::path share_folder() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  return program.parent_path().parent_path() / "share" / "roio";
}

}  // namespace roio::cli

#endif
