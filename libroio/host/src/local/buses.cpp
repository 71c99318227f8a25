#include <algorithm>
#include <filesystem>
#include <roio/bus_list.hpp>
#include <roio/text.hpp>
#include <system_error>

#include "local/place.hpp"

namespace roio {
namespace {

void find_in(const std::string& folder, std::vector<std::string>& found) {
  std::error_code unknown;
  if (std::filesystem::status(folder, unknown).type() == std::filesystem::file_type::not_found) {
    return;
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
        local::Place(path.stem().string()).find()) {
      found.push_back(url);
    }
  }
}

}  // namespace

std::vector<std::string> local_buses() {
  std::vector<std::string> found;
  for (const std::string& folder : local::folders()) {
    find_in(folder, found);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace roio
