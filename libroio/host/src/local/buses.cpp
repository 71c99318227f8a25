#include <algorithm>
#include <filesystem>
#include <roio/bus_list.hpp>
#include <roio/text.hpp>
#include <system_error>

#include "local/place.hpp"

namespace roio {

std::vector<std::string> local_buses() {
  std::vector<std::string> found;
  const std::string folder = local::folder();
  std::error_code unknown;
  if (std::filesystem::status(folder, unknown).type() == std::filesystem::file_type::not_found) {
    return found;
  }
  std::error_code error;
  const std::filesystem::directory_iterator entries(folder, error);
  if (error) {
    throw std::system_error(error, folder);
  }
  for (const auto& entry : entries) {
    const std::filesystem::path& path = entry.path();
    const std::string url = "local:" + path.stem().string();
    // A hub that was killed leaves its socket; only a living one answers.
    if (path.extension() == ".sock" && parse_bus_url(url) &&
        local::Place(path.stem().string()).connect()) {
      found.push_back(url);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace roio
