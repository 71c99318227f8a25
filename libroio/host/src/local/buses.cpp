#include <algorithm>
#include <filesystem>
#include <roio/bus_list.hpp>
#include <roio/text.hpp>

#include "local/place.hpp"

namespace roio {

std::vector<std::string> local_buses() {
  std::vector<std::string> found;
  const std::string folder = local::folder();
  if (!std::filesystem::exists(folder)) {
    return found;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
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
